#include <eunoe/discovery/inference/amplitude_posterior.h>
#include <eunoe/discovery/inference/calibration.h>

#include <boost/random/discrete_distribution.hpp>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

namespace {

using Pick = boost::random::discrete_distribution<std::size_t>;

/// Mean log probability of the truths of twins.
/// @param log_posterior of each model, a column for each twin
double log_score(const Eigen::ArrayXXd &log_posterior, const std::vector<std::size_t> &truths)
{
  double sum = -log_sums(log_posterior).sum();
  for (std::size_t i = 0; i < truths.size(); ++i)
    sum += log_posterior(static_cast<Eigen::Index>(truths[i]), static_cast<Eigen::Index>(i));
  return sum / static_cast<double>(truths.size());
}

} // namespace

Calibration calibrate(const Evidence &evidence, const double threshold, const unsigned int draws,
                      const std::uint32_t seed)
{
  Twins twins(evidence.target(), seed + 1);
  RandomStream random(seed, 29);
  const std::vector<std::size_t> usable = evidence.usable();
  Calibration result;
  if (usable.empty())
    return result;
  std::vector<std::size_t> truths;
  std::vector<double> amplitudes;
  Eigen::MatrixXd data(evidence.target().data().size(), draws);
  for (unsigned int i = 0; i < draws; ++i) {
    truths.push_back(random.index(usable.size()));
    const auto &places = evidence.places(usable[truths.back()]);
    std::vector<double> prior;
    for (const Evidence::Place &place : places)
      prior.push_back(std::exp(place.log_prior));
    const Evidence::Place &place = places[Pick(prior)(random)];
    amplitudes.push_back(place.amplitude);
    data.col(i) = twins.draw(place.hypothesis.prediction);
  }
  Evidence::Singles singles = evidence.singles(data);
  const Eigen::ArrayXXd posterior = singles.log_posterior();
  const Eigen::ArrayXd all = log_sums(posterior), factors = all - evidence.log_nothing(data);
  std::vector<Eigen::Index> detected;
  std::vector<std::size_t> truths_detected;
  std::vector<double> likelier;
  for (Eigen::Index i = 0; i < data.cols(); ++i) {
    if (factors(i) < threshold)
      continue;
    const std::size_t truth = truths[static_cast<std::size_t>(i)], effect = usable[truth];
    const Model alone = evidence.single(effect, data.col(i));
    Eigen::Index first = 0;
    result.stated += std::exp(posterior.col(i).maxCoeff(&first) - all(i));
    result.right += first == static_cast<Eigen::Index>(truth) ? 1. : 0.;
    likelier.push_back(AmplitudePosterior(evidence, alone, data.col(i), effect)
                           .likelier_than(amplitudes[static_cast<std::size_t>(i)]));
    detected.push_back(i);
    truths_detected.push_back(truth);
  }
  result.twins = static_cast<unsigned int>(detected.size());
  if (detected.empty())
    return result;
  const auto n = static_cast<double>(detected.size());
  result.stated /= n;
  result.right /= n;
  singles.log_evidence =
      Eigen::ArrayXXd(singles.log_evidence(Eigen::seqN(0, singles.log_evidence.rows()), detected));
  double highest = -1e300;
  // Never below 1: twins know nothing of what is wrong with the model besides.
  for (double temperature = 1.; temperature < 3.; temperature *= 1.05)
    if (const double score = log_score(singles.log_posterior(temperature), truths_detected);
        score > highest)
    {
      highest = score;
      result.temperature = temperature;
    }
  std::sort(likelier.begin(), likelier.end());
  constexpr double inside = 0.95;
  result.coverage = static_cast<double>(std::count_if(likelier.begin(), likelier.end(),
                                                      [](double p) { return p < inside; })) /
                    n;
  result.interval = std::max(inside, likelier[static_cast<std::size_t>(inside * n)]);
  return result;
}

std::optional<double> detectable(const Evidence &evidence, const std::size_t effect,
                                 const bool above, const double threshold, const std::uint32_t seed)
{
  constexpr unsigned int draws = 25;
  constexpr double power = 0.8;
  std::vector<const Evidence::Place *> side;
  for (const Evidence::Place &place : evidence.places(effect))
    if ((place.amplitude > 0.) == above)
      side.push_back(&place);
  const auto is_seen = [&](const Evidence::Place &place) {
    Twins twins(evidence.target(), seed);
    const Eigen::ArrayXd factors =
        evidence.log_bayes_factors(twins.draw(place.hypothesis.prediction, draws));
    return static_cast<double>((factors >= threshold).count()) >= power * draws;
  };
  if (side.empty() || !is_seen(*side.back()))
    return std::nullopt;
  std::size_t low = 0, high = side.size() - 1;
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    if (is_seen(*side[middle]))
      high = middle;
    else
      low = middle + 1;
  }
  return side[low]->amplitude;
}

} // namespace eunoe::discovery
