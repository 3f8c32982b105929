#include <eunoe/discovery/inference/amplitude_posterior.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

namespace eunoe::discovery {

namespace {

/// Amplitudes of one of two effects, as logarithms of their ratios to the best one, which has the
/// same sign.
class Axis
{
public:
  Axis(const std::vector<Evidence::Place> &places, const std::size_t effect, const double best)
      : effect(effect), best(best)
  {
    constexpr double around = 1.2;
    for (const Evidence::Place &place : places)
      if (const double ratio = place.amplitude / best; ratio > 0.) {
        lowest = std::min(lowest, std::log(ratio));
        highest = std::max(highest, std::log(ratio));
      }
    span(std::max(lowest, -around), std::min(highest, around));
  }

  /// Fits the axis to the members that matter, with a cell around them, or with more where they lie
  /// at its end.
  /// @return whether it changed clearly
  bool fit(const std::vector<Member> &members)
  {
    constexpr double matters = 1e-4, growth = 0.5, clearly = 0.7;
    double low = 1e300, high = -1e300;
    for (const Member &member : members)
      if (member.probability > matters) {
        const double shift = std::log(member.effects.at(effect) / best);
        low = std::min(low, shift);
        high = std::max(high, shift);
      }
    const double first = shifts(0), last = shifts(shifts.size() - 1), cell = shifts(1) - first;
    const auto margin = [&](const double to_end) {
      return to_end < 0.5 * cell ? growth * (last - first) : cell;
    };
    low = std::max(low - margin(low - first), lowest);
    high = std::min(high + margin(last - high), highest);
    span(low, high);
    return high - low < clearly * (last - first) || low < first - 0.5 * cell ||
           high > last + 0.5 * cell;
  }

  const std::size_t effect;
  const double best;
  Eigen::VectorXd shifts;

private:
  void span(const double low, const double high)
  {
    constexpr int number = 21;
    shifts = Eigen::VectorXd::LinSpaced(number, low, high);
  }

  double lowest = 0., highest = 0.; ///< of the effect's range
};

} // namespace

double log_density(const Evidence &evidence, const Hypothesis &likeliest,
                   const EffectPositions &effects, const Target::Prediction &prediction,
                   const Eigen::VectorXd &data)
{
  double result = evidence.log_likelihoods_about(likeliest, prediction.mean, data)(0);
  for (const auto &[k, amplitude] : effects)
    result += evidence.place_near(k, amplitude).log_reference;
  return result;
}

std::vector<Member> members(const Evidence &evidence, const Model &model,
                            const Eigen::VectorXd &data)
{
  const Hypothesis likeliest = evidence.prepare(evidence.target().predict(model.best));
  std::vector<Member> result;
  const auto set_probabilities = [&] {
    std::vector<double> logs;
    for (const Member &member : result)
      logs.push_back(log_density(evidence, likeliest, member.effects, member.prediction, data));
    const std::vector<double> shares = shares_of(std::move(logs));
    for (std::size_t i = 0; i < result.size(); ++i)
      result[i].probability = shares[i];
  };
  if (model.effects.size() == 1) {
    const std::size_t k = model.effects.front();
    for (const Evidence::Place &place : evidence.places(k))
      result.push_back({{{k, place.amplitude}}, place.hypothesis.prediction, 0.});
    set_probabilities();
    return result;
  }
  std::vector<Axis> axes;
  for (const auto &[k, amplitude] : model.best)
    axes.emplace_back(evidence.places(k), k, amplitude);
  const Axis &a = axes[0], &b = axes[1];
  constexpr int most_rounds = 8;
  for (int i = 0; i <= most_rounds; ++i) {
    result.clear();
    for (const double x : a.shifts)
      for (const double y : b.shifts) {
        const EffectPositions effects = {{a.effect, a.best * std::exp(x)},
                                         {b.effect, b.best * std::exp(y)}};
        result.push_back({effects, evidence.target().predict(effects), 0.});
      }
    set_probabilities();
    bool changed = false;
    for (Axis &axis : axes)
      changed |= axis.fit(result);
    if (!changed)
      break;
  }
  return result;
}

AmplitudePosterior::AmplitudePosterior(const Evidence &evidence, const Model &model,
                                       const Eigen::VectorXd &data, const std::size_t effect)
{
  std::map<double, double> marginal;
  for (const Member &member : members(evidence, model, data))
    marginal[member.effects.at(effect)] += member.probability;
  for (const auto &[amplitude, probability] : marginal)
    sorted.push_back({amplitude, probability,
                      std::log(std::max(probability, 1e-300)) -
                          evidence.place_near(effect, amplitude).log_reference});
  constexpr int in_cell = 8;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const double here = sorted[i].amplitude;
    const double low = i == 0 ? here : 0.5 * (sorted[i - 1].amplitude + here);
    const double high = i + 1 == sorted.size() ? here : 0.5 * (here + sorted[i + 1].amplitude);
    for (int k = 0; k < in_cell; ++k) {
      const double width = (high - low) / in_cell, start = low + k * width;
      slices.push_back({start, start + width, sorted[i].probability / in_cell,
                        log_likelihood_at(start + 0.5 * width)});
    }
  }
}

double AmplitudePosterior::log_likelihood_at(const double amplitude) const
{
  const auto above =
      std::lower_bound(sorted.begin(), sorted.end(), amplitude,
                       [](const Place &place, const double u) { return place.amplitude < u; });
  if (above == sorted.begin() || above == sorted.end())
    return above == sorted.begin() ? above->log_likelihood : sorted.back().log_likelihood;
  const Place &below = *std::prev(above);
  const double share = (amplitude - below.amplitude) / (above->amplitude - below.amplitude);
  return (1. - share) * below.log_likelihood + share * above->log_likelihood;
}

double AmplitudePosterior::likelier_than(const double amplitude) const
{
  const double here = log_likelihood_at(amplitude);
  double result = 0.;
  for (const Slice &slice : slices)
    result += slice.log_likelihood > here ? slice.probability : 0.;
  return result;
}

std::pair<double, double> AmplitudePosterior::likeliest(const double probability) const
{
  std::vector<Slice> all = slices;
  std::sort(all.begin(), all.end(),
            [](const Slice &a, const Slice &b) { return a.log_likelihood > b.log_likelihood; });
  double low = all.front().low, high = all.front().high, sum = 0.;
  for (const Slice &slice : all) {
    if (sum >= probability)
      break;
    sum += slice.probability;
    low = std::min(low, slice.low);
    high = std::max(high, slice.high);
  }
  return {low, high};
}

double AmplitudePosterior::quantile(const double share) const
{
  double sum = 0.;
  for (const Slice &slice : slices) {
    if (sum + slice.probability >= share)
      return slice.low +
             (slice.high - slice.low) * (share - sum) / std::max(slice.probability, 1e-300);
    sum += slice.probability;
  }
  return sorted.back().amplitude;
}

} // namespace eunoe::discovery
