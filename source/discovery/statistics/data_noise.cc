#include <eunoe/discovery/statistics/data_noise.h>
#include <eunoe/discovery/statistics/logarithms.h>
#include <eunoe/discovery/tuned.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace eunoe::discovery {

namespace {

/// What one observable says of the ratio of variances.
struct Witness
{
  double ratio, degrees_of_freedom;
};

Witness witness(const Modes::Group &group, const Eigen::MatrixXd &replicate_covariance,
                const Eigen::VectorXd &deviation, const Eigen::VectorXd &repeats)
{
  double ratio = 0., number = 0.;
  for (const Eigen::Index c : group.points) {
    ratio += deviation(c) * deviation(c);
    number += repeats(c);
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

/// Probabilities of all up to each.
std::vector<double> cumulated(std::vector<double> probabilities)
{
  std::partial_sum(probabilities.begin(), probabilities.end(), probabilities.begin());
  return probabilities;
}

/// Number of the first up to which there is so much of the probability.
std::size_t place_of(const double share, const std::vector<double> &below)
{
  const auto place = std::lower_bound(below.begin(), below.end(), share);
  return static_cast<std::size_t>(std::min(place, below.end() - 1) - below.begin());
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
  double prior = 0., before = 0.;
  std::vector<double> logs;
  for (double value = first; value < last; value *= step) {
    // Each value stands for those since the last one.
    logs.push_back(std::log(value - before) - value / expected -
                   0.5 * degrees_of_freedom * (std::log1p(value) + ratio / (1. + value)));
    prior += (value - before) * std::exp(-value / expected);
    values.push_back(value);
    before = value;
  }
  const std::vector<double> shares = shares_of(logs);
  average = std::inner_product(values.begin(), values.end(), shares.begin(), 0.);
  below = cumulated(shares);
  log_of_all = log_sum(logs) - std::log(prior);
}

double ExcessVariance::draw(RandomStream &random) const
{
  return values[place_of(random.uniform(), below)];
}

InstrumentNoise::InstrumentNoise(const Modes &modes, const Eigen::MatrixXd &replicate_covariance,
                                 const Eigen::VectorXd &deviation, const Eigen::VectorXd &repeats)
{
  // The prior is half of a Cauchy distribution.
  using tuned::instrument::coarsest;
  constexpr double lowest = 0.01, step = 1.35;
  std::vector<double> logs;
  for (double common = lowest; common < coarsest; common *= step) {
    std::vector<ExcessVariance> groups;
    double log = std::log(common) - std::log1p(std::pow(common / tuned::instrument::usual, 2));
    for (const Modes::Group &group : modes.groups()) {
      const Witness w = witness(group, replicate_covariance, deviation, repeats);
      const bool is_far = w.ratio > coarsest;
      groups.emplace_back(w.ratio, w.degrees_of_freedom, is_far ? w.ratio : common);
      log += is_far ? 0. : groups.back().log_evidence();
    }
    logs.push_back(log);
    levels.push_back(std::move(groups));
  }
  below = cumulated(shares_of(std::move(logs)));
}

const std::vector<ExcessVariance> &InstrumentNoise::at(const double quantile) const
{
  return levels[place_of(quantile, below)];
}

} // namespace eunoe::discovery
