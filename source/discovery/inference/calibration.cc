#include <eunoe/discovery/inference/amplitude_posterior.h>
#include <eunoe/discovery/inference/calibration.h>

#include <boost/random/discrete_distribution.hpp>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

namespace {

using Pick = boost::random::discrete_distribution<std::size_t>;

/// Mean log probability of the truths of some twins.
/// @param log_posterior of each model, a column for each twin
double log_score(const Eigen::ArrayXXd &log_posterior, const std::vector<std::size_t> &truths,
                 const std::vector<std::size_t> &twins)
{
  const Eigen::ArrayXd all = log_sums(log_posterior);
  double sum = 0.;
  for (const std::size_t i : twins) {
    const auto column = static_cast<Eigen::Index>(i);
    sum += log_posterior(static_cast<Eigen::Index>(truths[i]), column) - all(column);
  }
  return sum / static_cast<double>(twins.size());
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
  const Evidence::Singles singles = evidence.singles(data);
  const Eigen::ArrayXXd posterior = singles.log_posterior();
  const Eigen::ArrayXd all = log_sums(posterior), factors = all - evidence.log_nothing(data);
  std::vector<std::size_t> detected;
  std::vector<double> likelier;
  for (std::size_t i = 0; i < truths.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    if (factors(column) < threshold)
      continue;
    const Eigen::VectorXd twin = data.col(column);
    const std::size_t effect = usable[truths[i]];
    Eigen::Index first = 0;
    result.stated += std::exp(posterior.col(column).maxCoeff(&first) - all(column));
    result.right += first == static_cast<Eigen::Index>(truths[i]) ? 1. : 0.;
    likelier.push_back(AmplitudePosterior(evidence, evidence.single(effect, twin), twin, effect)
                           .likelier_than(amplitudes[i]));
    detected.push_back(i);
  }
  result.twins = static_cast<unsigned int>(detected.size());
  if (detected.empty())
    return result;
  const auto n = static_cast<double>(detected.size());
  result.stated /= n;
  result.right /= n;
  double highest = -1e300;
  for (double temperature = tuned::twins::least_temperature;
       temperature < tuned::twins::highest_temperature; temperature *= 1.05)
    if (const double score = log_score(singles.log_posterior(temperature), truths, detected);
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
  std::vector<const Evidence::Place *> side;
  for (const Evidence::Place &place : evidence.places(effect))
    if ((place.amplitude > 0.) == above)
      side.push_back(&place);
  const auto is_seen = [&](const Evidence::Place &place) {
    Twins twins(evidence.target(), seed);
    const Eigen::ArrayXd factors =
        evidence.log_bayes_factors(twins.draw(place.hypothesis.prediction, draws));
    return static_cast<double>((factors >= threshold).count()) >= tuned::twins::power * draws;
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
