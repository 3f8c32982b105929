#include <eunoe/discovery/inference/emulator.h>
#include <eunoe/discovery/statistics/covariance.h>
#include <eunoe/discovery/tuned.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace eunoe::discovery {

namespace {

bool less(const Eigen::VectorXd &a, const Eigen::VectorXd &b)
{
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

} // namespace

ExperimentEmulator::ExperimentEmulator(const FactorSpace &space, const std::vector<Sample> &samples,
                                       const std::vector<Eigen::Index> &columns,
                                       const std::vector<DataPoint> &points,
                                       const Eigen::VectorXd &least_deviation)
    : n_effects(space.n_effects()), n_nuisances(space.n_nuisances())
{
  const Eigen::MatrixXd of_base = runs_of_base(samples, columns);
  mean = of_base.colwise().mean().transpose();
  reduction = Modes(points, discovery::deviations(of_base).cwiseMax(least_deviation));
  const std::vector<Group> groups = make_groups(samples, columns);
  estimate_covariance(groups, [](const Group &group) { return group.effect == -1; });
  // Few runs make a covariance in whose units all others scatter too much.
  constexpr int rounds = 2;
  for (int i = 0; i < rounds; ++i) {
    fit_scatter(groups);
    estimate_covariance(groups, [this](const Group &group) { return is_near_base(group); });
  }
  // The directions in which data are weighed most are those in which the covariance happens to be
  // small: new data scatter more along them (Dodelson and Schneider 2013).
  whitening *= std::sqrt(1. - own);
  fit_scatter(groups);
  // Runs with any effect tell of the base model, too, mostly of its nuisances. All emulators share
  // that: one that knew more of the base model than the others would describe data in which nothing
  // is missing better than they do.
  const BaseInformation without_effects = information_of_base(groups);
  BaseInformation all = without_effects;
  std::vector<BaseInformation> of_effects;
  for (std::size_t k = 0; k < n_effects; ++k) {
    std::vector<GaussianProcess::Point> with;
    for (const Group &group : groups)
      if (group.effect == static_cast<int>(k)) {
        const double u = group.amplitude();
        with.push_back({u, group.position.tail(static_cast<Eigen::Index>(n_nuisances)),
                        whitening * group.mean,
                        chaos.common(k, u) / static_cast<double>(group.rows.rows())});
      }
    processes.emplace_back(std::move(with), without_effects);
    of_effects.push_back(processes.back().about_base());
    all += of_effects.back();
  }
  alone = GaussianProcess({}, all).predict(0.);
  for (std::size_t k = 0; k < n_effects; ++k)
    processes[k].set_base(all - of_effects[k]);
}

std::vector<ExperimentEmulator::Group> ExperimentEmulator::make_groups(
    const std::vector<Sample> &samples, const std::vector<Eigen::Index> &columns) const
{
  std::map<Eigen::VectorXd, std::vector<const Sample *>, decltype(&less)> sorted(&less);
  for (const Sample &sample : samples)
    sorted[sample.position].push_back(&sample);
  std::vector<Group> groups;
  for (const auto &[position, runs] : sorted) {
    Group group;
    group.position = position;
    group.rows.resize(static_cast<Eigen::Index>(runs.size()), reduction.n_modes());
    for (std::size_t r = 0; r < runs.size(); ++r)
      group.rows.row(static_cast<Eigen::Index>(r)) =
          reduction.reduce(runs[r]->values(columns) - mean).transpose();
    group.mean = group.rows.colwise().mean().transpose();
    for (std::size_t e = 0; e < n_effects; ++e)
      if (position(static_cast<Eigen::Index>(e)) != 0.)
        group.effect = group.effect == -1 ? static_cast<int>(e) : -2;
    groups.push_back(std::move(group));
  }
  return groups;
}

bool ExperimentEmulator::is_near_base(const Group &group) const
{
  using tuned::scatter::weak;
  if (group.effect < 0)
    return group.effect == -1;
  const Scatter::Replicates replicates = whitened(group);
  const auto k = static_cast<std::size_t>(group.effect);
  const double noise = static_cast<double>(size()) / replicates.runs;
  return replicates.change.squaredNorm() < weak * weak + noise &&
         chaos.of_modes(k, replicates.amplitude, replicates.change).maxCoeff() <
             tuned::scatter::alike * chaos.common(k, replicates.amplitude);
}

double ExperimentEmulator::Group::amplitude() const
{
  return effect < 0 ? 0. : position(static_cast<Eigen::Index>(effect));
}

Scatter::Replicates ExperimentEmulator::whitened(const Group &group) const
{
  const Eigen::MatrixXd deviations = centred(group.rows) * whitening.transpose();
  return {group.effect, group.amplitude(), whitening * group.mean,
          deviations.colwise().squaredNorm().transpose(), static_cast<double>(group.rows.rows())};
}

void ExperimentEmulator::estimate_covariance(const std::vector<Group> &groups,
                                             const std::function<bool(const Group &)> &condition)
{
  std::vector<const Group *> used;
  Eigen::Index n = 0;
  dof = 0.;
  for (const Group &group : groups)
    if (const Eigen::Index r = group.rows.rows(); r > 1 && condition(group)) {
      used.push_back(&group);
      n += r;
      dof += static_cast<double>(r - 1);
    }
  Eigen::MatrixXd deviations(n, reduction.n_modes()), unbiased = deviations;
  Eigen::Index row = 0;
  for (const Group *const group : used) {
    const Eigen::Index r = group->rows.rows();
    deviations.middleRows(row, r) = centred(group->rows);
    if (group->effect >= 0)
      deviations.middleRows(row, r) /=
          std::sqrt(chaos.likeliest(static_cast<std::size_t>(group->effect), group->amplitude()));
    unbiased.middleRows(row, r) = deviations.middleRows(row, r) *
                                  std::sqrt(static_cast<double>(r) / static_cast<double>(r - 1));
    row += r;
  }
  const Covariance covariance = shrunk_covariance(deviations, dof);
  const Eigen::LLT<Eigen::MatrixXd> llt(covariance.matrix);
  whitening =
      llt.matrixL().solve(Eigen::MatrixXd::Identity(reduction.n_modes(), reduction.n_modes()));
  residuals = unbiased * whitening.transpose();
  // A run that the covariance was not estimated from lies farther out: as far as each row would if
  // it were left out (Sherman and Morrison).
  constexpr double least = 0.05;
  const Eigen::VectorXd left =
      (1. - (1. - covariance.shrinkage) * residuals.rowwise().squaredNorm().array() / dof)
          .cwiseMax(least);
  residuals = left.cwiseSqrt().cwiseInverse().asDiagonal() * residuals;
  own = 1. - left.mean();
}

void ExperimentEmulator::fit_scatter(const std::vector<Group> &groups)
{
  std::vector<Scatter::Replicates> replicates;
  for (const Group &group : groups)
    replicates.push_back(whitened(group));
  chaos = Scatter(n_effects, replicates);
}

/// Regression of the runs without effects on the nuisances.
BaseInformation ExperimentEmulator::information_of_base(const std::vector<Group> &groups) const
{
  const auto n_terms = static_cast<Eigen::Index>(n_nuisances + 1);
  // A nuisance that could not be run changes nothing, with the uncertainty of a strong effect.
  constexpr double weak = 1e-4;
  Eigen::MatrixXd precision = weak * Eigen::MatrixXd::Identity(n_terms, n_terms),
                  weighted = Eigen::MatrixXd::Zero(n_terms, size());
  for (const Group &group : groups) {
    if (group.effect != -1)
      continue;
    Eigen::VectorXd terms(n_terms);
    terms << 1., group.position.tail(static_cast<Eigen::Index>(n_nuisances));
    const auto weight = static_cast<double>(group.rows.rows());
    precision += weight * terms * terms.transpose();
    weighted += weight * terms * (whitening * group.mean).transpose();
  }
  return {precision.reshaped().replicate(1, size()), weighted};
}

ExperimentEmulator::Prediction ExperimentEmulator::predict(const EffectPositions &effects) const
{
  Prediction result{alone, Eigen::VectorXd::Ones(size()), 1.};
  for (const auto &[k, amplitude] : effects) {
    const GaussianProcess::Prediction one = processes[k].predict(amplitude);
    const Eigen::VectorXd change = one.mean - alone.mean;
    const double common = chaos.common(k, amplitude);
    const Eigen::VectorXd scatter = chaos.of_modes(k, amplitude, change);
    result.outcome.mean += change;
    result.outcome.gradient += one.gradient - alone.gradient;
    // The process takes the noise of all modes for the same.
    result.outcome.leverage += one.leverage.cwiseProduct(scatter) / common - alone.leverage;
    result.scatter = result.scatter.cwiseProduct(scatter);
    result.common *= common;
  }
  result.outcome.leverage = result.outcome.leverage.cwiseMax(1e-4);
  return result;
}

Eigen::VectorXd ExperimentEmulator::whiten(const Eigen::VectorXd &values) const
{
  return whitening * reduction.reduce(values - mean);
}

Eigen::MatrixXd ExperimentEmulator::whiten_scaled(const Eigen::MatrixXd &columns) const
{
  return whitening * (reduction.basis() * columns);
}

Eigen::MatrixXd ExperimentEmulator::mode_covariance() const
{
  return unwhitening() * unwhitening().transpose();
}

Eigen::MatrixXd ExperimentEmulator::unwhitening() const
{
  return whitening.triangularView<Eigen::Lower>().solve(Eigen::MatrixXd::Identity(size(), size()));
}

Eigen::VectorXd ExperimentEmulator::growth(const Eigen::VectorXd &scatter) const
{
  const Eigen::MatrixXd base = reduction.basis().transpose() * unwhitening();
  const Eigen::ArrayXd before = base.rowwise().squaredNorm();
  const Eigen::ArrayXd after = (base.cwiseAbs2() * scatter).array();
  return (before > 0.).select(after / before, 1.);
}

Eigen::VectorXd ExperimentEmulator::values(const Eigen::VectorXd &whitened) const
{
  // The finest waves of long profiles, which the modes leave out, are those of the base model.
  const Eigen::VectorXd change = whitening.triangularView<Eigen::Lower>().solve(whitened);
  return mean + (reduction.basis().transpose() * change).cwiseProduct(reduction.deviations());
}

} // namespace eunoe::discovery
