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
  constexpr double first = 0.01, last = 1e8, step = 1.3;
  double sum = 0., highest = -1e300, before = 0.;
  std::vector<double> logs;
  for (double value = first; value < last; value *= step) {
    // Each value stands for those since the last one.
    logs.push_back(std::log(value - before) - value / expected -
                   0.5 * degrees_of_freedom * (std::log1p(value) + ratio / (1. + value)));
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
  for (double &share : below)
    share /= sum;
}

double ExcessVariance::draw(RandomStream &random) const
{
  const auto place = std::lower_bound(below.begin(), below.end(), random.uniform());
  return values[static_cast<std::size_t>(std::min(place, below.end() - 1) - below.begin())];
}

std::vector<ExcessVariance> excess_variances(const Modes &modes,
                                             const Eigen::MatrixXd &replicate_covariance,
                                             const Repeats &repeats)
{
  // An instrument is chosen such that its noise is a small part of the scatter, as a rule.
  constexpr double usual = 0.1, far = 10.;
  std::vector<Witness> witnesses;
  double sum = 0., weight = 1.;
  for (const Modes::Group &group : modes.groups()) {
    witnesses.push_back(witness(group, replicate_covariance, repeats));
    // An observable that hardly varies between runs says nothing about the others.
    if (witnesses.back().ratio > far)
      continue;
    sum += witnesses.back().degrees_of_freedom * (witnesses.back().ratio - 1.);
    weight += witnesses.back().degrees_of_freedom;
  }
  const double common = usual + std::max(0., sum / weight);
  std::vector<ExcessVariance> result;
  for (const Witness &one : witnesses)
    result.emplace_back(one.ratio, one.degrees_of_freedom, one.ratio > far ? one.ratio : common);
  return result;
}

} // namespace eunoe::discovery
