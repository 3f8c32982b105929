#include <eunoe/discovery/statistics/data_noise.h>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

namespace {

/// What one observable says of the ratio of variances.
struct Witness
{
  double ratio, degrees_of_freedom;
};

Witness witness(const Modes::Group &group, const Eigen::MatrixXd &replicate_covariance,
                const Repeats &repeats)
{
  double ratio = 0., number = 0.;
  for (const Eigen::Index c : group.points) {
    ratio += repeats.deviation(c) * repeats.deviation(c);
    number += repeats.number(c);
  }
  const auto n = static_cast<double>(group.points.size());
  double trace = 0., squares = 0.;
  for (const Eigen::Index i : group.modes)
    for (const Eigen::Index j : group.modes) {
      trace += i == j ? replicate_covariance(i, i) : 0.;
      squares += replicate_covariance(i, j) * replicate_covariance(i, j);
    }
  const double effective = std::max(1., trace * trace / squares);
  // The deviation of a single repeat was not estimated from repeats.
  constexpr double declared = 0.5;
  const double dof = number / n - 1.;
  return {ratio / n, dof < declared ? 0. : dof * effective};
}

} // namespace

ExcessVariance::ExcessVariance(const double ratio, const double degrees_of_freedom,
                               const double expected)
{
  if (degrees_of_freedom <= 0.) {
    values = {std::max(0., ratio - 1.)};
    below = {1.};
    average = values[0];
    return;
  }
  constexpr double first = 0.003, step = 1.3;
  const double last = std::max(1e8, 1e3 * ratio);
  double sum = 0., prior = 0., highest = -1e300, before = 0.;
  std::vector<double> logs;
  for (double value = first; value < last; value *= step) {
    // Each value stands for those since the last one.
    logs.push_back(std::log(value - before) - value / expected -
                   0.5 * degrees_of_freedom * (std::log1p(value) + ratio / (1. + value)));
    prior += (value - before) * std::exp(-value / expected);
    values.push_back(value);
    highest = std::max(highest, logs.back());
    before = value;
  }
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double weight = std::exp(logs[k] - highest);
    average += weight * values[k];
    below.push_back(sum += weight);
  }
  average /= sum;
  log_of_all = highest + std::log(sum / prior);
  for (double &share : below)
    share /= sum;
}

double ExcessVariance::draw(RandomStream &random) const
{
  const auto place = std::lower_bound(below.begin(), below.end(), random.uniform());
  return values[static_cast<std::size_t>(std::min(place, below.end() - 1) - below.begin())];
}

InstrumentNoise::InstrumentNoise(const Modes &modes, const Eigen::MatrixXd &replicate_covariance,
                                 const Repeats &repeats)
{
  // An instrument is chosen such that its noise is a small part of the scatter, as a rule: half of
  // the prior (half of a Cauchy distribution) is below `usual`.
  constexpr double usual = 0.1, lowest = 0.01, highest = 10., step = 1.35;
  std::vector<double> logs;
  for (double common = lowest; common < highest; common *= step) {
    Level one{0., {}};
    double log = std::log(common) - std::log1p(std::pow(common / usual, 2));
    for (const Modes::Group &group : modes.groups()) {
      const Witness w = witness(group, replicate_covariance, repeats);
      // An observable that hardly varies between runs says nothing about the others.
      const bool is_far = w.ratio > highest;
      one.groups.emplace_back(w.ratio, w.degrees_of_freedom, is_far ? w.ratio : common);
      log += is_far ? 0. : one.groups.back().log_evidence();
    }
    logs.push_back(log);
    levels.push_back(std::move(one));
  }
  const double largest = *std::max_element(logs.begin(), logs.end());
  double sum = 0.;
  for (std::size_t k = 0; k < levels.size(); ++k)
    levels[k].below = sum += std::exp(logs[k] - largest);
  for (Level &one : levels)
    one.below /= sum;
}

const InstrumentNoise::Level &InstrumentNoise::level(const double quantile) const
{
  const auto place =
      std::lower_bound(levels.begin(), levels.end(), quantile,
                       [](const Level &one, const double share) { return one.below < share; });
  return *std::min(place, levels.end() - 1);
}

Eigen::VectorXd InstrumentNoise::at(const double quantile) const
{
  const Level &one = level(quantile);
  Eigen::VectorXd result(static_cast<Eigen::Index>(one.groups.size()));
  for (std::size_t g = 0; g < one.groups.size(); ++g)
    result(static_cast<Eigen::Index>(g)) = one.groups[g].mean();
  return result;
}

Eigen::VectorXd InstrumentNoise::draw(const double quantile, RandomStream &random) const
{
  const Level &one = level(quantile);
  Eigen::VectorXd result(static_cast<Eigen::Index>(one.groups.size()));
  for (std::size_t g = 0; g < one.groups.size(); ++g)
    result(static_cast<Eigen::Index>(g)) = one.groups[g].draw(random);
  return result;
}

} // namespace eunoe::discovery
