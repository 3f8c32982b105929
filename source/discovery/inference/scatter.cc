#include <eunoe/discovery/inference/scatter.h>
#include <eunoe/discovery/tuned.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace eunoe::discovery {

Eigen::ArrayXd Scatter::Replicates::squared_change() const
{
  return (change.array().square() - 1. / runs).cwiseMax(0.);
}

Eigen::ArrayXd Scatter::Replicates::log_likelihood(const Eigen::ArrayXd &variance) const
{
  return -0.5 * tuned::scatter::independent_share *
         ((runs - 1.) * variance.log() + square.array() / variance);
}

Scatter::Scatter(const std::size_t n_effects, const std::vector<Replicates> &all)
    : growth(n_effects, 0.), largest(n_effects, 1.)
{
  const Eigen::Index n_modes = all.empty() ? 0 : all.front().change.size();
  shares = Eigen::MatrixXd::Zero(n_modes, static_cast<Eigen::Index>(n_effects));
  for (std::size_t k = 0; k < n_effects; ++k) {
    std::vector<const Replicates *> groups;
    double most = 0.;
    for (const Replicates &group : all)
      if (group.effect == static_cast<int>(k)) {
        most = std::max(most, std::abs(group.amplitude));
        if (group.runs > 1.)
          groups.push_back(&group);
      }
    if (most == 0.)
      continue;
    largest[k] = most;
    // What is common and what is each mode's own are known from the same runs.
    constexpr int rounds = 2;
    for (int i = 0; i < rounds; ++i) {
      fit_growth(k, groups);
      fit_shares(k, groups);
    }
  }
}

double Scatter::common(const std::size_t effect, const double amplitude) const
{
  return std::clamp(likeliest(effect, amplitude), 1., tuned::scatter::most_growth);
}

Eigen::VectorXd Scatter::of_modes(const std::size_t effect, const double amplitude,
                                  const Eigen::VectorXd &change) const
{
  const auto share = shares.col(static_cast<Eigen::Index>(effect)).array();
  return share * change.cwiseAbs2().array() + common(effect, amplitude);
}

double Scatter::likeliest(const std::size_t effect, const double amplitude) const
{
  return std::exp(growth[effect] * std::sqrt(std::abs(amplitude) / largest[effect]));
}

/// A prior keeps the growth near that of the base model where few replicates tell.
void Scatter::fit_growth(const std::size_t effect, const std::vector<const Replicates *> &groups)
{
  constexpr double least = -1., most = 2.4, step = 0.2;
  const auto column = static_cast<Eigen::Index>(effect);
  double highest = -std::numeric_limits<double>::infinity(), best = 0.;
  for (double b = least; b < most + 0.5 * step; b += step) {
    double log_likelihood = -0.5 * std::pow(b / tuned::scatter::growth_deviation, 2);
    growth[effect] = b;
    for (const Replicates *group : groups)
      log_likelihood += group
                            ->log_likelihood(shares.col(column).array() * group->squared_change() +
                                             likeliest(effect, group->amplitude))
                            .sum();
    if (log_likelihood > highest) {
      highest = log_likelihood;
      best = b;
    }
  }
  growth[effect] = best;
}

/// Mean of the squared share of each mode. Few are large, so that the prior of a share falls
/// exponentially.
void Scatter::fit_shares(const std::size_t effect, const std::vector<const Replicates *> &groups)
{
  constexpr double candidates[] = {0., 0.03, 0.06, 0.1, 0.15, 0.2, 0.3, 0.45, 0.7, 1., 1.5};
  const auto column = static_cast<Eigen::Index>(effect);
  const auto n = static_cast<Eigen::Index>(std::size(candidates));
  Eigen::ArrayXXd logs(shares.rows(), n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double share = candidates[i];
    // Candidates stand for intervals of unequal width.
    const double width =
        0.5 * (candidates[std::min(i + 1, n - 1)] - candidates[std::max<Eigen::Index>(i - 1, 0)]);
    logs.col(i).setConstant(std::log(width) - share / tuned::scatter::typical_share);
    for (const Replicates *group : groups)
      logs.col(i) += group->log_likelihood(share * share * group->squared_change() +
                                           likeliest(effect, group->amplitude));
  }
  const Eigen::ArrayXXd weights = (logs.colwise() - logs.rowwise().maxCoeff()).exp();
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(shares.rows());
  for (Eigen::Index i = 0; i < n; ++i)
    sum += weights.col(i) * candidates[i] * candidates[i];
  shares.col(column) = sum / weights.rowwise().sum();
}

} // namespace eunoe::discovery
