#include <eunoe/discovery/inference/amplitude_posterior.h>
#include <eunoe/discovery/inference/calibration.h>

#include <boost/random/discrete_distribution.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace eunoe::discovery {

namespace {

using Pick = boost::random::discrete_distribution<std::size_t>;

/// A twin in which an effect was detected: log posterior of each model, and which is the truth.
struct Trial
{
  std::vector<double> log_posterior;
  std::size_t truth = 0;
};

double log_score(const std::vector<Trial> &trials, const double temperature)
{
  double sum = 0.;
  for (const Trial &trial : trials) {
    std::vector<double> tempered = trial.log_posterior;
    for (double &value : tempered)
      value /= temperature;
    sum += tempered[trial.truth] - log_sum(tempered);
  }
  return sum;
}

} // namespace

Calibration calibrate(const Evidence &evidence, const double threshold, const unsigned int draws,
                      const std::uint32_t seed)
{
  Twins twins(evidence, seed + 1);
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
  const Eigen::ArrayXXd posterior = evidence.log_posterior_of_singles(data);
  const Eigen::ArrayXd factors = log_sums(posterior) - evidence.log_nothing(data);
  std::vector<Trial> trials;
  std::vector<double> likelier;
  for (unsigned int i = 0; i < draws; ++i) {
    if (factors(i) < threshold)
      continue;
    const std::size_t effect = usable[truths[i]];
    const Eigen::ArrayXd logs = posterior.col(i);
    Trial trial{{logs.begin(), logs.end()}, truths[i]};
    Model alone;
    alone.effects = {effect};
    alone.best[effect] = evidence.best_amplitude(effect, data.col(i));
    Eigen::Index first = 0;
    const double highest = logs.maxCoeff(&first);
    result.stated += std::exp(highest - log_sum(trial.log_posterior));
    result.right += first == static_cast<Eigen::Index>(truths[i]) ? 1. : 0.;
    likelier.push_back(
        AmplitudePosterior(evidence, alone, data.col(i), effect).likelier_than(amplitudes[i]));
    trials.push_back(std::move(trial));
  }
  result.twins = static_cast<unsigned int>(trials.size());
  if (trials.empty())
    return result;
  const auto n = static_cast<double>(trials.size());
  result.stated /= n;
  result.right /= n;
  double highest = -1e300;
  // Never below 1: twins know nothing of what is wrong with the model besides.
  for (double temperature = 1.; temperature < 3.; temperature *= 1.05)
    if (const double score = log_score(trials, temperature); score > highest) {
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
    Twins twins(evidence, seed);
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
