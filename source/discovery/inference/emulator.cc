#include <eunoe/discovery/inference/emulator.h>
#include <eunoe/discovery/statistics/covariance.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace eunoe::discovery {

namespace {

/// Standard deviation of each column between runs of the base model.
Eigen::VectorXd base_deviations(const Eigen::MatrixXd &rows, const Eigen::VectorXd &least)
{
  const Eigen::VectorXd deviation =
      (centred(rows).colwise().squaredNorm().transpose() / static_cast<double>(rows.rows() - 1))
          .cwiseSqrt();
  return deviation.cwiseMax(least);
}

bool less(const Eigen::VectorXd &a, const Eigen::VectorXd &b)
{
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

} // namespace

ExperimentEmulator::ExperimentEmulator(const FactorSpace &space, const std::vector<Sample> &samples,
                                       const std::vector<Eigen::Index> &columns,
                                       const std::vector<DataPoint> &points,
                                       const Eigen::VectorXd &least_deviation)
    : n_effects(space.n_effects()), n_nuisances(space.n_nuisances()), growth(n_effects, 0.),
      largest(n_effects, 1.)
{
  std::vector<const Sample *> of_base;
  for (const Sample &sample : samples)
    if (sample.position.isZero(0.))
      of_base.push_back(&sample);
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(of_base.size()),
                       static_cast<Eigen::Index>(columns.size()));
  for (std::size_t r = 0; r < of_base.size(); ++r)
    rows.row(static_cast<Eigen::Index>(r)) = of_base[r]->values(columns).transpose();
  mean = rows.colwise().mean().transpose();
  reduction = Modes(points, base_deviations(rows, least_deviation));
  const std::vector<Group> groups = make_groups(samples, columns);
  estimate_covariance(without_effects(groups));
  fit_scatter(groups);
  estimate_covariance(near_base(groups));
  const BaseInformation without_effects = information_of_base(groups);
  for (std::size_t k = 0; k < n_effects; ++k) {
    std::vector<GaussianProcess::Point> with;
    for (const Group &group : groups)
      if (group.effect == static_cast<int>(k)) {
        const double u = group.position(static_cast<Eigen::Index>(k));
        with.push_back({u, group.position.tail(static_cast<Eigen::Index>(n_nuisances)),
                        whitening * group.mean,
                        scatter_at(k, u) / static_cast<double>(group.rows.rows())});
      }
    processes.emplace_back(std::move(with), without_effects);
  }
  share_base(without_effects);
}

std::vector<ExperimentEmulator::Group> ExperimentEmulator::make_groups(
    const std::vector<Sample> &samples, const std::vector<Eigen::Index> &columns) const
{
  std::vector<const Sample *> sorted;
  for (const Sample &sample : samples)
    sorted.push_back(&sample);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Sample *a, const Sample *b) { return less(a->position, b->position); });
  std::vector<Group> groups;
  for (std::size_t k = 0; k < sorted.size();) {
    std::size_t end = k;
    while (end < sorted.size() && sorted[end]->position == sorted[k]->position)
      ++end;
    Group group;
    group.position = sorted[k]->position;
    group.rows.resize(static_cast<Eigen::Index>(end - k), reduction.n_modes());
    for (std::size_t r = k; r < end; ++r)
      group.rows.row(static_cast<Eigen::Index>(r - k)) =
          reduction.reduce(sorted[r]->values(columns) - mean).transpose();
    group.mean = group.rows.colwise().mean().transpose();
    for (std::size_t e = 0; e < n_effects; ++e)
      if (group.position(static_cast<Eigen::Index>(e)) != 0.)
        group.effect = group.effect == -1 ? static_cast<int>(e) : -2;
    groups.push_back(std::move(group));
    k = end;
  }
  return groups;
}

std::vector<ExperimentEmulator::Group> ExperimentEmulator::without_effects(
    const std::vector<Group> &groups)
{
  std::vector<Group> result;
  std::copy_if(groups.begin(), groups.end(), std::back_inserter(result),
               [](const Group &group) { return group.effect == -1; });
  return result;
}

std::vector<ExperimentEmulator::Group> ExperimentEmulator::near_base(
    const std::vector<Group> &groups) const
{
  constexpr double weak = 4.; // standard deviations of a run
  std::vector<Group> result;
  std::copy_if(groups.begin(), groups.end(), std::back_inserter(result), [&](const Group &group) {
    const double noise = static_cast<double>(size()) / static_cast<double>(group.rows.rows());
    return group.effect == -1 ||
           (group.effect >= 0 && (whitening * group.mean).squaredNorm() < weak * weak + noise);
  });
  return result;
}

void ExperimentEmulator::estimate_covariance(const std::vector<Group> &groups)
{
  Eigen::Index n = 0;
  double degrees = 0.;
  for (const Group &group : groups)
    if (group.rows.rows() > 1) {
      n += group.rows.rows();
      degrees += static_cast<double>(group.rows.rows() - 1);
    }
  Eigen::MatrixXd deviations(n, reduction.n_modes()), unbiased = deviations;
  Eigen::Index row = 0;
  for (const Group &group : groups) {
    const Eigen::Index r = group.rows.rows();
    if (r < 2)
      continue;
    const auto k = static_cast<std::size_t>(std::max(0, group.effect));
    const double scale =
        group.effect < 0
            ? 1.
            : 1. / std::sqrt(scatter_at(k, group.position(static_cast<Eigen::Index>(k))));
    deviations.middleRows(row, r) = scale * centred(group.rows);
    unbiased.middleRows(row, r) = deviations.middleRows(row, r) *
                                  std::sqrt(static_cast<double>(r) / static_cast<double>(r - 1));
    row += r;
  }
  const Covariance covariance = shrunk_covariance(
      deviations, degrees, std::vector<int>(static_cast<std::size_t>(reduction.n_modes()), 0));
  const Eigen::LLT<Eigen::MatrixXd> llt(covariance.matrix);
  whitening =
      llt.matrixL().solve(Eigen::MatrixXd::Identity(reduction.n_modes(), reduction.n_modes()));
  residuals = unbiased * whitening.transpose();
  dof = degrees;
  // A run that the covariance was not estimated from lies farther out: as far as each row would if
  // it were left out (Sherman and Morrison).
  constexpr double least = 0.05;
  for (Eigen::Index i = 0; i < residuals.rows(); ++i)
    residuals.row(i) /= std::sqrt(
        std::max(least, 1. - (1. - covariance.shrinkage) * residuals.row(i).squaredNorm() / dof));
}

/// The scatter of runs with an effect grows exponentially with the root of its amplitude. A prior
/// keeps it near that of the base model where few replicates tell. It does not shrink: data that
/// happen to lie nearer than expected would speak for any effect with less scatter.
void ExperimentEmulator::fit_scatter(const std::vector<Group> &groups)
{
  constexpr double prior_deviation = 0.7, most = 2.3, step = 0.1;
  // Chaos is not normal, and modes are correlated beyond what shrinkage leaves.
  constexpr double independent_share = 0.5;
  for (std::size_t k = 0; k < n_effects; ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    largest[k] = 0.;
    for (const Group &group : groups)
      if (group.effect == static_cast<int>(k))
        largest[k] = std::max(largest[k], std::abs(group.position(at)));
    if (largest[k] == 0.)
      continue;
    double highest = -std::numeric_limits<double>::infinity(), best = 0.;
    for (double b = 0.; b < most + 0.5 * step; b += step) {
      double log_likelihood = -0.5 * std::pow(b / prior_deviation, 2);
      for (const Group &group : groups) {
        const auto r = static_cast<double>(group.rows.rows());
        if (group.effect != static_cast<int>(k) || r < 2.)
          continue;
        const double t = b * std::sqrt(std::abs(group.position(at)) / largest[k]);
        const double square =
            (centred(group.rows) * whitening.transpose()).squaredNorm() * independent_share;
        const double number = (r - 1.) * static_cast<double>(size()) * independent_share;
        log_likelihood -= 0.5 * (number * t + square * std::exp(-t));
      }
      if (log_likelihood > highest) {
        highest = log_likelihood;
        best = b;
      }
    }
    growth[k] = best;
  }
}

double ExperimentEmulator::scatter_at(const std::size_t effect, const double amplitude) const
{
  if (growth[effect] == 0.)
    return 1.;
  constexpr double most = 10.;
  return std::min(most,
                  std::exp(growth[effect] * std::sqrt(std::abs(amplitude) / largest[effect])));
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
  return {std::vector<Eigen::MatrixXd>(static_cast<std::size_t>(size()), precision), weighted};
}

/// Runs with any effect tell of the base model, too, mostly of its nuisances. All emulators share
/// that: one that knew more of the base model than the others would describe data in which nothing
/// is missing better than they do.
void ExperimentEmulator::share_base(BaseInformation all)
{
  std::vector<BaseInformation> parts;
  for (const GaussianProcess &process : processes) {
    parts.push_back(process.about_base());
    all += parts.back();
  }
  alone = GaussianProcess({}, all).predict(0.);
  for (std::size_t k = 0; k < n_effects; ++k) {
    BaseInformation others = all;
    others -= parts[k];
    processes[k].set_base(others);
  }
}

GaussianProcess::Prediction ExperimentEmulator::predict(
    const std::map<std::size_t, double> &effects) const
{
  GaussianProcess::Prediction result = alone;
  for (const auto &[k, amplitude] : effects) {
    const GaussianProcess::Prediction one = processes[k].predict(amplitude);
    result.mean += one.mean - alone.mean;
    result.gradient += one.gradient - alone.gradient;
    result.leverage += one.leverage - alone.leverage;
  }
  result.leverage = result.leverage.cwiseMax(1e-4);
  return result;
}

double ExperimentEmulator::scatter(const std::map<std::size_t, double> &effects) const
{
  double product = 1.;
  for (const auto &[k, amplitude] : effects)
    product *= scatter_at(k, amplitude);
  return product;
}

Eigen::VectorXd ExperimentEmulator::values(const Eigen::VectorXd &whitened) const
{
  // The finest waves of long profiles, which the modes leave out, are those of the base model.
  const Eigen::VectorXd change = whitening.triangularView<Eigen::Lower>().solve(whitened);
  return mean + (reduction.basis().transpose() * change).cwiseProduct(reduction.deviations());
}

} // namespace eunoe::discovery
