#include <eunoe/discovery/statistics/data_noise.h>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

namespace {

/// Estimate of the ratio of variances from one observable, and its degrees of freedom.
struct Witness
{
  double ratio, weight;
  bool declared; ///< a single repeat: the deviation was not estimated from repeats

  /// Where repeats vary far more than replicates, the cause is the instrument, or an observable
  /// that hardly varies between replicates. Such a ratio is not shared with other observables.
  bool stands_alone() const
  {
    constexpr double most = 10.;
    return ratio > most;
  }
};

Witness witness(const Modes::Group &group, const Eigen::MatrixXd &replicate_covariance,
                const Eigen::VectorXd &replicate_variance, const Repeats &repeats)
{
  double ratio = 0., number = 0.;
  for (const Eigen::Index c : group.points) {
    ratio += repeats.deviation(c) * repeats.deviation(c) / replicate_variance(c);
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
  const bool declared = number / n < 1.5;
  return {ratio / n, std::max(0., number / n - 1.) * effective, declared};
}

} // namespace

DataNoise estimate_data_noise(const Modes &modes, const Eigen::MatrixXd &replicate_covariance,
                              const Eigen::VectorXd &replicate_variance, const Repeats &repeats)
{
  // Degrees of freedom of the priors: no noise of the instrument for all observables together, and
  // their mean for a single one.
  constexpr double weight_of_one = 4., weight_of_mean = 6.;
  std::vector<Witness> witnesses;
  double sum = weight_of_one, weight = weight_of_one;
  for (const Modes::Group &group : modes.groups()) {
    witnesses.push_back(witness(group, replicate_covariance, replicate_variance, repeats));
    if (witnesses.back().stands_alone())
      continue;
    sum += witnesses.back().weight * witnesses.back().ratio;
    weight += witnesses.back().weight;
  }

  DataNoise noise;
  const Eigen::Index n = modes.n_points();
  noise.ratio = Eigen::VectorXd::Ones(n);
  noise.point_variance = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd instrument(n), share = Eigen::VectorXd::Zero(modes.n_modes());
  for (std::size_t g = 0; g < witnesses.size(); ++g) {
    const Witness &w = witnesses[g];
    const double ratio =
        w.declared || w.stands_alone()
            ? std::max(1., w.ratio)
            : (weight_of_mean * sum / weight + w.weight * w.ratio) / (weight_of_mean + w.weight);
    double repeats_inverse = 0.;
    for (const Eigen::Index c : modes.groups()[g].points) {
      noise.ratio(c) = ratio;
      instrument(c) = std::max(0., ratio - 1.) * replicate_variance(c) / repeats.number(c);
      noise.point_variance(c) = ratio * replicate_variance(c) / repeats.number(c);
      repeats_inverse += 1. / repeats.number(c);
    }
    repeats_inverse /= static_cast<double>(modes.groups()[g].points.size());
    for (const Eigen::Index m : modes.groups()[g].modes)
      share(m) = std::sqrt(std::min(1., ratio) * repeats_inverse);
  }
  noise.modes = share.asDiagonal() * replicate_covariance * share.asDiagonal();
  noise.modes += modes.basis() * instrument.asDiagonal() * modes.basis().transpose();
  return noise;
}

} // namespace eunoe::discovery
