#include <eunoe/discovery/inference/calibration.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace eunoe::discovery {

namespace {

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

/// An index drawn by weights that are logarithms and sum to one.
std::size_t draw_place(const std::vector<Evidence::Place> &places, RandomStream &random)
{
  double left = random.uniform();
  for (std::size_t i = 0; i < places.size(); ++i) {
    left -= std::exp(places[i].log_prior);
    if (left < 0.)
      return i;
  }
  return places.size() - 1;
}

} // namespace

AmplitudePosterior::AmplitudePosterior(const std::vector<Evidence::Place> &places,
                                       const std::vector<double> &log_weights)
{
  const double total = log_sum(log_weights);
  for (std::size_t i = 0; i < places.size(); ++i)
    sorted.emplace_back(places[i].amplitude, std::exp(log_weights[i] - total));
  std::sort(sorted.begin(), sorted.end());
}

double AmplitudePosterior::quantile(const double share) const
{
  double sum = 0.;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const double next = sum + sorted[i].second;
    if (next >= share) {
      // Each place stands for the amplitudes half-way to its neighbours.
      const double low = i == 0 ? sorted[i].first : 0.5 * (sorted[i - 1].first + sorted[i].first);
      const double high =
          i + 1 == sorted.size() ? sorted[i].first : 0.5 * (sorted[i].first + sorted[i + 1].first);
      return low + (high - low) * (share - sum) / std::max(sorted[i].second, 1e-300);
    }
    sum = next;
  }
  return sorted.back().first;
}

double AmplitudePosterior::below(const double amplitude) const
{
  double sum = 0.;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const double low = i == 0 ? sorted[i].first : 0.5 * (sorted[i - 1].first + sorted[i].first);
    const double high =
        i + 1 == sorted.size() ? sorted[i].first : 0.5 * (sorted[i].first + sorted[i + 1].first);
    if (amplitude < high)
      return sum + sorted[i].second *
                       std::clamp((amplitude - low) / std::max(high - low, 1e-300), 0., 1.);
    sum += sorted[i].second;
  }
  return sum;
}

AmplitudePosterior amplitude_posterior(const Evidence &evidence, const std::size_t effect,
                                       const Eigen::VectorXd &data, const Model &model)
{
  std::vector<double> weights;
  for (const Evidence::Place &place : evidence.places(effect)) {
    std::map<std::size_t, double> effects = model.best;
    effects[effect] = place.amplitude;
    weights.push_back(place.log_reference +
                      (effects.size() == 1
                           ? evidence.log_likelihood(place.hypothesis, data)
                           : evidence.log_likelihood(
                                 evidence.prepare(evidence.target().predict(effects)), data)));
  }
  return {evidence.places(effect), weights};
}

Calibration calibrate(const Evidence &evidence, const double threshold, const unsigned int draws,
                      const std::uint32_t seed)
{
  Twins twins(evidence, seed + 1);
  RandomStream random(seed, 29);
  std::vector<std::size_t> usable;
  for (std::size_t k = 0; k < evidence.space().n_effects(); ++k)
    if (!evidence.places(k).empty())
      usable.push_back(k);
  Calibration result;
  std::vector<Trial> trials;
  std::vector<double> tails;
  for (unsigned int i = 0; i < draws && !usable.empty(); ++i) {
    const std::size_t truth = random.index(usable.size());
    const auto &places = evidence.places(usable[truth]);
    const Evidence::Place &place = places[draw_place(places, random)];
    const Eigen::VectorXd data = twins.draw(place.hypothesis.prediction);
    if (evidence.log_bayes_factor(data) < threshold)
      continue;
    Trial trial{evidence.log_posterior_of_singles(data), truth};
    const double total = log_sum(trial.log_posterior);
    const auto first = std::max_element(trial.log_posterior.begin(), trial.log_posterior.end());
    result.stated += std::exp(*first - total);
    result.right +=
        first - trial.log_posterior.begin() == static_cast<std::ptrdiff_t>(truth) ? 1. : 0.;
    const double below = amplitude_posterior(evidence, usable[truth], data).below(place.amplitude);
    tails.push_back(std::min(below, 1. - below));
    trials.push_back(std::move(trial));
  }
  result.twins = static_cast<unsigned int>(trials.size());
  if (trials.empty())
    return result;
  const auto n = static_cast<double>(trials.size());
  result.stated /= n;
  result.right /= n;
  double highest = -1e300;
  for (double temperature = 0.7; temperature < 3.; temperature *= 1.05)
    if (const double score = log_score(trials, temperature); score > highest) {
      highest = score;
      result.temperature = temperature;
    }
  std::sort(tails.begin(), tails.end());
  constexpr double outside = 0.05;
  result.tail = std::min(0.5 * outside, tails[static_cast<std::size_t>(outside * n)]);
  result.coverage = static_cast<double>(std::count_if(tails.begin(), tails.end(),
                                                      [](double t) { return t > 0.5 * outside; })) /
                    n;
  return result;
}

std::optional<double> detectable(const Evidence &evidence, const std::size_t effect,
                                 const bool above, const double threshold, const std::uint32_t seed)
{
  constexpr int draws = 25;
  constexpr double power = 0.8;
  std::vector<const Evidence::Place *> side;
  for (const Evidence::Place &place : evidence.places(effect))
    if ((place.amplitude > 0.) == above)
      side.push_back(&place);
  const auto is_seen = [&](const Evidence::Place &place) {
    Twins twins(evidence, seed);
    int seen = 0;
    for (int k = 0; k < draws; ++k)
      seen += evidence.log_bayes_factor(twins.draw(place.hypothesis.prediction)) >= threshold;
    return seen >= power * draws;
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
