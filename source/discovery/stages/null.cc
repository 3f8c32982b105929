#include <eunoe/core/problems.h>
#include <eunoe/discovery/stages/stages.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace eunoe::discovery {

namespace {

/// Standard deviation of each data point between replicates of the base model. It is at least a
/// share of the observable's typical deviation, so that a difference in the last digit is not
/// significant. It is 0 where neither runs nor measurements vary.
Eigen::VectorXd replicate_deviations(const StudyState &study,
                                     const std::vector<MeasuredPoint> &data)
{
  constexpr double least_share = 0.2;
  const auto n = static_cast<Eigen::Index>(study.data_points.size());
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(study.base().size()), n);
  for (std::size_t r = 0; r < study.base().size(); ++r)
    rows.row(static_cast<Eigen::Index>(r)) = study.measured(study.base()[r].values).transpose();
  const Eigen::VectorXd deviation =
      (centred(rows).colwise().squaredNorm().transpose() / static_cast<double>(rows.rows() - 1))
          .cwiseSqrt();
  Eigen::VectorXd result = deviation;
  for (Eigen::Index c = 0; c < n; ++c) {
    std::vector<double> same;
    for (Eigen::Index d = 0; d < n; ++d) {
      const DataPoint &a = study.data_points[static_cast<std::size_t>(c)];
      const DataPoint &b = study.data_points[static_cast<std::size_t>(d)];
      if (a.experiment == b.experiment && a.observable == b.observable)
        same.push_back(deviation(d));
    }
    std::sort(same.begin(), same.end());
    double typical = same[same.size() / 2];
    if (typical <= 0.)
      typical = same.back();
    const double size = std::abs(rows.col(c).mean());
    if (typical <= 1e-12 * size)
      typical = data[static_cast<std::size_t>(c)].standard_deviation / least_share;
    result(c) = std::max(deviation(c), least_share * typical);
  }
  return result;
}

std::vector<Eigen::Index> columns_of_points(const StudyState &study)
{
  std::vector<Eigen::Index> result;
  for (const DataPoint &point : study.data_points)
    result.push_back(std::find(study.columns.begin(), study.columns.end(), point) -
                     study.columns.begin());
  return result;
}

/// Leaves out data points that never vary, and fixes values, units and order of the rest.
void choose_data_points(StudyState &study)
{
  std::vector<MeasuredPoint> data = study.data.fit;
  const Eigen::VectorXd all = replicate_deviations(study, data);
  std::vector<MeasuredPoint> used;
  std::vector<double> deviations;
  for (std::size_t c = 0; c < data.size(); ++c) {
    const double deviation = all(static_cast<Eigen::Index>(c));
    if (deviation > 0.) {
      used.push_back(data[c]);
      deviations.push_back(deviation);
    } else {
      study.notes.push_back("Left out, as it varies neither in runs nor in the measurement: " +
                            data[c].point.experiment + ", " + data[c].point.observable +
                            ", index " + std::to_string(data[c].point.index) + ".");
    }
  }
  if (used.empty())
    throw UserError("No measured cell varies in the runs of the base model, so nothing can be "
                    "compared: give standard deviations, or cells that vary.");
  const auto n = static_cast<Eigen::Index>(used.size());
  study.data_points.clear();
  study.value.resize(n);
  study.deviation.resize(n);
  study.repeats.resize(n);
  for (Eigen::Index c = 0; c < n; ++c) {
    const MeasuredPoint &point = used[static_cast<std::size_t>(c)];
    study.data_points.push_back(point.point);
    study.value(c) = point.value;
    study.deviation(c) = point.standard_deviation;
    study.repeats(c) = point.repeats;
  }
  study.column_of_point = columns_of_points(study);
  study.set_modes(Modes(study.data_points, Eigen::Map<Eigen::VectorXd>(deviations.data(), n)));
}

/// A nuisance's values on both sides. Two prior deviations make a clearer change than one, and are
/// mostly small enough for a linear response.
std::array<double, 2> nuisance_values(const Factor &nuisance)
{
  constexpr double step = 2.;
  return {std::max(nuisance.lower, nuisance.null_value - step * nuisance.prior_deviation),
          std::min(nuisance.upper, nuisance.null_value + step * nuisance.prior_deviation)};
}

/// Changes of the data points by one prior deviation of a nuisance: a row for each seed with runs
/// on both sides; where the sides have no seeds in common, for each pair of their runs; and where
/// one side fails, for each run on the other with a seed of the base model.
Eigen::MatrixXd changes_by(StudyState &study, const Factor &nuisance)
{
  const auto [low, high] = nuisance_values(nuisance);
  const auto &up = study.replicates[{{nuisance.name, high}}],
             &down = study.replicates[{{nuisance.name, low}}];
  std::vector<Eigen::VectorXd> rows;
  const auto add = [&](const Replicate &a, const Replicate &b, double step, bool is_pair) {
    if (is_pair && step > 0.)
      rows.push_back((study.measured(a.values) - study.measured(b.values)) *
                     (nuisance.prior_deviation / step));
  };
  for (const Replicate &a : up)
    for (const Replicate &b : down)
      add(a, b, high - low, a.seed == b.seed);
  if (rows.size() < 2)
    for (std::size_t k = 0; k < std::min(up.size(), down.size()); ++k)
      add(up[k], down[k], high - low, up[k].seed != down[k].seed);
  if (rows.size() < 2)
    for (const Replicate &base : study.base()) {
      for (const Replicate &run : up)
        add(run, base, high - nuisance.null_value, run.seed == base.seed);
      for (const Replicate &run : down)
        add(base, run, nuisance.null_value - low, run.seed == base.seed);
    }
  Eigen::MatrixXd result(static_cast<Eigen::Index>(rows.size()), study.modes.n_points());
  for (std::size_t r = 0; r < rows.size(); ++r)
    result.row(static_cast<Eigen::Index>(r)) =
        rows[r].cwiseQuotient(study.modes.deviations()).transpose();
  return result;
}

/// Estimates the change by each nuisance, and the noise of these estimates, which counts as noise
/// of the comparison.
void estimate_nuisance_changes(StudyState &study)
{
  const Misfit white(study.replicate_covariance.matrix, 0. * study.replicate_covariance.matrix);
  study.nuisance_noise = 0.;
  study.nuisance_changes = Eigen::MatrixXd::Zero(study.modes.n_points(),
                                                 static_cast<Eigen::Index>(study.nuisances.size()));
  for (std::size_t k = 0; k < study.nuisances.size(); ++k) {
    const Eigen::MatrixXd rows = changes_by(study, study.nuisances[k]);
    if (rows.rows() < 2) {
      study.notes.push_back("The nuisance " + study.nuisances[k].name +
                            " could not be simulated and is not profiled out.");
      continue;
    }
    const auto number = static_cast<double>(rows.rows());
    study.nuisance_changes.col(static_cast<Eigen::Index>(k)) = rows.colwise().mean().transpose();
    study.nuisance_noise +=
        white.coordinates(study.modes.basis() * centred(rows).transpose()).squaredNorm() /
        ((number - 1.) * number * static_cast<double>(study.modes.n_modes()));
  }
}

} // namespace

void run_base_design(StudyState &study, const unsigned int base, const unsigned int nuisance)
{
  std::vector<DesignPoint> design = {{{}, base}};
  for (const Factor &factor : study.nuisances)
    for (const double value : nuisance_values(factor))
      design.push_back({{{factor.name, value}}, nuisance});
  study.run_design(design);
}

void estimate_noise(StudyState &study)
{
  estimate_replicate_covariance(study);
  estimate_nuisance_changes(study);
  estimate_replicate_covariance(study);
}

Table stage_null(StudyState &study)
{
  study.column_of_point = columns_of_points(study);
  run_base_design(study, study.options.null_runs, study.options.nuisance_runs);
  if (study.base().size() < 8)
    throw UserError("Only " + std::to_string(study.base().size()) + " of " +
                    std::to_string(study.options.null_runs) +
                    " sets of runs of the base model came to their end, and at least 8 are needed: "
                    "raise the budget, or see why runs fail.");
  choose_data_points(study);
  estimate_noise(study);

  Table table = {{"base runs", study.base().size()},
                 {"cells", study.data_points.size()},
                 {"modes", study.modes.n_modes()},
                 {"shrinkage of correlations", study.replicate_covariance.shrinkage}};
  table["variance of a repeat over that of a run"] = Table::array();
  for (const Modes::Group &group : study.modes.groups())
    table["variance of a repeat over that of a run"].push_back(
        {{"experiment", group.experiment},
         {"observable", group.observable},
         {"ratio", study.noise.ratio(group.points.front())}});
  return table;
}

} // namespace eunoe::discovery
