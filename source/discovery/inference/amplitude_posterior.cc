#include <eunoe/discovery/inference/amplitude_posterior.h>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

namespace {

/// A grid of two effects' amplitudes: logarithms of their ratios to the best ones, which have the
/// same signs.
class Grid
{
public:
  Grid(const Evidence &evidence, const Model &model, const AmplitudeDensity &density)
      : evidence(evidence), density(density), best(model.best)
  {
    constexpr double around = 1.2;
    for (const auto &[k, amplitude] : best) {
      auto &[low, high] = ranges[k];
      for (const Evidence::Place &place : evidence.places(k))
        if (place.amplitude / amplitude > 0.) {
          low = std::min(low, std::log(place.amplitude / amplitude));
          high = std::max(high, std::log(place.amplitude / amplitude));
        }
      axes[k] = points(std::max(low, -around), std::min(high, around));
    }
  }

  std::vector<Member> evaluate() const
  {
    std::vector<Member> result;
    const auto &[first, rows] = *axes.begin();
    const auto &[second, columns] = *axes.rbegin();
    for (const double x : rows)
      for (const double y : columns) {
        Member member;
        member.effects = {{first, best.at(first) * std::exp(x)},
                          {second, best.at(second) * std::exp(y)}};
        member.prediction = evidence.target().predict(member.effects);
        member.log_weight = density.log(member.effects, member.prediction);
        result.push_back(std::move(member));
      }
    return result;
  }

  /// Fits the grid to the members that matter, with a cell around them, or with more where they lie
  /// at its end.
  /// @return whether it changed clearly
  bool fit(const std::vector<Member> &members)
  {
    constexpr double matters = 1e-4, growth = 0.5, clearly = 0.7;
    const std::vector<double> probabilities = weights(members);
    bool changed = false;
    for (auto &[k, axis] : axes) {
      double low = 1e300, high = -1e300;
      for (std::size_t i = 0; i < members.size(); ++i)
        if (probabilities[i] > matters) {
          const double shift = std::log(members[i].effects.at(k) / best.at(k));
          low = std::min(low, shift);
          high = std::max(high, shift);
        }
      const double first = axis(0), last = axis(axis.size() - 1), cell = axis(1) - first;
      const auto margin = [&](const double to_end) {
        return to_end < 0.5 * cell ? growth * (last - first) : cell;
      };
      low = std::max(low - margin(low - first), ranges.at(k).first);
      high = std::min(high + margin(last - high), ranges.at(k).second);
      changed |= high - low < clearly * (last - first) || low < first - 0.5 * cell ||
                 high > last + 0.5 * cell;
      axis = points(low, high);
    }
    return changed;
  }

private:
  static Eigen::VectorXd points(const double low, const double high)
  {
    constexpr int number = 21;
    return Eigen::VectorXd::LinSpaced(number, low, high);
  }

  const Evidence &evidence;
  const AmplitudeDensity &density;
  const std::map<std::size_t, double> best;
  std::map<std::size_t, std::pair<double, double>> ranges;
  std::map<std::size_t, Eigen::VectorXd> axes;
};

} // namespace

AmplitudeDensity::AmplitudeDensity(const Evidence &evidence, const Model &model,
                                   const Eigen::VectorXd &data)
    : evidence(evidence), data(data),
      at_best(evidence.prepare(evidence.target().predict(model.best)))
{
}

double AmplitudeDensity::log(const std::map<std::size_t, double> &effects,
                             const Target::Prediction &prediction) const
{
  double result = evidence.log_likelihoods_about(at_best, prediction.mean, data)(0);
  for (const auto &[k, amplitude] : effects)
    result += evidence.place_near(k, amplitude).log_reference;
  return result;
}

std::vector<Member> members(const Evidence &evidence, const Model &model,
                            const Eigen::VectorXd &data)
{
  const AmplitudeDensity density(evidence, model, data);
  std::vector<Member> result;
  if (model.effects.size() == 1) {
    const std::size_t k = model.effects.front();
    for (const Evidence::Place &place : evidence.places(k)) {
      const std::map<std::size_t, double> effects = {{k, place.amplitude}};
      const Target::Prediction &prediction = place.hypothesis.prediction;
      result.push_back({effects, prediction, density.log(effects, prediction)});
    }
    return result;
  }
  constexpr int most_rounds = 8;
  Grid grid(evidence, model, density);
  result = grid.evaluate();
  for (int i = 0; i < most_rounds && grid.fit(result); ++i)
    result = grid.evaluate();
  return result;
}

std::vector<double> weights(const std::vector<Member> &members)
{
  std::vector<double> result;
  for (const Member &member : members)
    result.push_back(member.log_weight);
  const double total = result.empty() ? 0. : log_sum(result);
  for (double &weight : result)
    weight = std::exp(weight - total);
  return result;
}

AmplitudePosterior::AmplitudePosterior(const Evidence &evidence, const Model &model,
                                       const Eigen::VectorXd &data, const std::size_t effect)
{
  const std::vector<Member> all = members(evidence, model, data);
  const std::vector<double> probabilities = discovery::weights(all);
  std::map<double, double> marginal;
  for (std::size_t i = 0; i < all.size(); ++i)
    marginal[all[i].effects.at(effect)] += probabilities[i];
  sorted.assign(marginal.begin(), marginal.end());
  for (const auto &[amplitude, probability] : sorted)
    log_likelihood.push_back(std::log(std::max(probability, 1e-300)) -
                             evidence.place_near(effect, amplitude).log_reference);
}

std::pair<double, double> AmplitudePosterior::cell(const std::size_t place) const
{
  const double here = sorted[place].first;
  return {place == 0 ? here : 0.5 * (sorted[place - 1].first + here),
          place + 1 == sorted.size() ? here : 0.5 * (here + sorted[place + 1].first)};
}

std::vector<AmplitudePosterior::Slice> AmplitudePosterior::slices() const
{
  constexpr int in_cell = 8;
  std::vector<Slice> result;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const auto [low, high] = cell(i);
    for (int k = 0; k < in_cell; ++k) {
      const double width = (high - low) / in_cell, start = low + k * width;
      result.push_back({start, start + width, sorted[i].second / in_cell,
                        log_likelihood_at(start + 0.5 * width)});
    }
  }
  return result;
}

double AmplitudePosterior::log_likelihood_at(const double amplitude) const
{
  const auto above = std::lower_bound(
      sorted.begin(), sorted.end(), amplitude,
      [](const std::pair<double, double> &place, double value) { return place.first < value; });
  if (above == sorted.begin() || above == sorted.end())
    return above == sorted.begin() ? log_likelihood.front() : log_likelihood.back();
  const auto i = static_cast<std::size_t>(above - sorted.begin());
  const double share = (amplitude - sorted[i - 1].first) / (above->first - sorted[i - 1].first);
  return (1. - share) * log_likelihood[i - 1] + share * log_likelihood[i];
}

double AmplitudePosterior::likelier_than(const double amplitude) const
{
  const double here = log_likelihood_at(amplitude);
  double result = 0.;
  for (const Slice &slice : slices())
    result += slice.log_likelihood > here ? slice.probability : 0.;
  return result;
}

std::pair<double, double> AmplitudePosterior::likeliest(const double probability) const
{
  std::vector<Slice> all = slices();
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
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const double next = sum + sorted[i].second;
    if (next >= share) {
      const auto [low, high] = cell(i);
      return low + (high - low) * (share - sum) / std::max(sorted[i].second, 1e-300);
    }
    sum = next;
  }
  return sorted.back().first;
}

} // namespace eunoe::discovery
