#include <eunoe/discovery/stages/held_out.h>
#include <eunoe/discovery/stages/stages.h>
#include <eunoe/discovery/statistics/random_stream.h>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

namespace {

/// Distance of a nuisance's runs from its null value, in prior deviations, as in the stage null.
constexpr double nuisance_step = 2.;

std::vector<std::string> experiments_of(const std::vector<MeasuredPoint> &points)
{
  std::vector<std::string> experiments;
  for (const MeasuredPoint &point : points)
    if (std::find(experiments.begin(), experiments.end(), point.point.experiment) ==
        experiments.end())
      experiments.push_back(point.point.experiment);
  return experiments;
}

/// Few runs are enough, because the two sides are four prior deviations apart: that divides the
/// variance of the change by one prior deviation by sixteen.
unsigned int nuisance_runs(const StudyOptions &options)
{
  return std::max(1u, options.nuisance_runs / 2);
}

/// Replicates of all held-out experiments, one row for each seed for which no run failed.
Eigen::MatrixXd run_rows(StudyState &study, const Amplitudes &amplitudes, const unsigned int number)
{
  const std::vector<MeasuredPoint> &points = study.data.held_out;
  const std::vector<std::string> experiments = experiments_of(points);
  std::vector<RunRequest> requests;
  for (unsigned int k = 0; k < number; ++k)
    for (const std::string &experiment : experiments)
      requests.push_back({experiment, amplitudes, 100000u * study.options.seed + 1u + k});
  if (requests.size() > study.archive.remaining())
    return {};
  const std::vector<RunResult> results = study.archive.get(requests);
  std::vector<Eigen::VectorXd> rows;
  for (unsigned int k = 0; k < number; ++k) {
    Eigen::VectorXd row(static_cast<Eigen::Index>(points.size()));
    for (std::size_t c = 0; c < points.size(); ++c) {
      const auto e = static_cast<std::size_t>(
          std::find(experiments.begin(), experiments.end(), points[c].point.experiment) -
          experiments.begin());
      const RunResult &result = results[k * experiments.size() + e];
      const auto &known = study.archive.simulator().data_points(points[c].point.experiment);
      const auto place = std::find(known.begin(), known.end(), points[c].point) - known.begin();
      row(static_cast<Eigen::Index>(c)) =
          result ? (*result)[static_cast<std::size_t>(place)] : std::nan("");
    }
    if (row.allFinite())
      rows.push_back(row);
  }
  Eigen::MatrixXd matrix(static_cast<Eigen::Index>(rows.size()),
                         static_cast<Eigen::Index>(points.size()));
  for (std::size_t r = 0; r < rows.size(); ++r)
    matrix.row(static_cast<Eigen::Index>(r)) = rows[r].transpose();
  return matrix;
}

/// Changes of all held-out data points by one prior deviation of each nuisance; zero where a side
/// failed.
Eigen::MatrixXd nuisance_changes(StudyState &study, const unsigned int number)
{
  Eigen::MatrixXd changes =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(study.data.held_out.size()),
                            static_cast<Eigen::Index>(study.nuisances.size()));
  for (std::size_t k = 0; k < study.nuisances.size(); ++k) {
    const Factor &nuisance = study.nuisances[k];
    const double low =
        std::max(nuisance.lower, nuisance.null_value - nuisance_step * nuisance.prior_deviation);
    const double high =
        std::min(nuisance.upper, nuisance.null_value + nuisance_step * nuisance.prior_deviation);
    const Eigen::MatrixXd up = run_rows(study, {{nuisance.name, high}}, number);
    const Eigen::MatrixXd down = run_rows(study, {{nuisance.name, low}}, number);
    if (up.rows() > 0 && down.rows() > 0)
      changes.col(static_cast<Eigen::Index>(k)) =
          (up.colwise().mean() - down.colwise().mean()).transpose() *
          (nuisance.prior_deviation / (high - low));
    else
      study.notes.push_back("The nuisance " + nuisance.name +
                            " could not be simulated in the held-out experiments and is not "
                            "profiled out there.");
  }
  return changes;
}

/// Unit of each data point: its deviation between replicates, and at least a share of its
/// observable's typical deviation and of the measurement's.
Eigen::VectorXd units(const std::vector<MeasuredPoint> &points, const Eigen::MatrixXd &before)
{
  const Eigen::VectorXd scatter =
      (centred(before).colwise().squaredNorm().transpose() / static_cast<double>(before.rows() - 1))
          .cwiseSqrt();
  Eigen::VectorXd result(scatter.size());
  for (std::size_t c = 0; c < points.size(); ++c) {
    const auto k = static_cast<Eigen::Index>(c);
    double typical = 0., number = 0.;
    for (std::size_t d = 0; d < points.size(); ++d)
      if (points[d].point.experiment == points[c].point.experiment &&
          points[d].point.observable == points[c].point.observable)
      {
        typical += scatter(static_cast<Eigen::Index>(d));
        number += 1.;
      }
    result(k) = std::max({scatter(k), 0.3 * typical / number, 0.3 * points[c].standard_deviation});
  }
  return result;
}

/// Estimates from replicates and repeats at the held-out data points.
struct Estimates
{
  Misfit misfit;
  Covariance replicate_covariance;
  DataNoise noise;
};

/// @param others replicates of another model or no rows; scaled to the same total variance, they
///   add to the estimate of the covariance
Estimates estimate(const Modes &modes, const Eigen::MatrixXd &runs, const Eigen::MatrixXd &others,
                   const Repeats &repeats, const Eigen::MatrixXd &uncertainty)
{
  Eigen::MatrixXd points(runs.rows() + others.rows(), runs.cols());
  points.topRows(runs.rows()) = centred(runs);
  if (others.rows() > 0) {
    const Eigen::MatrixXd deviations = centred(others);
    const double own =
        points.topRows(runs.rows()).squaredNorm() / static_cast<double>(runs.rows() - 1);
    const double theirs = deviations.squaredNorm() / static_cast<double>(others.rows() - 1);
    points.bottomRows(others.rows()) = deviations * (theirs > 0. ? std::sqrt(own / theirs) : 1.);
  }
  const auto dof = static_cast<double>(points.rows() - (others.rows() > 0 ? 2 : 1));
  Estimates result;
  result.replicate_covariance =
      shrunk_covariance(points * modes.basis().transpose(), dof, modes.experiment_of_mode());
  result.replicate_covariance.matrix.diagonal().array() += 1e-3;
  const Eigen::VectorXd replicate_variance =
      (points.colwise().squaredNorm().transpose() / dof).cwiseMax(0.04);
  result.noise =
      estimate_data_noise(modes, result.replicate_covariance.matrix, replicate_variance, repeats);
  const Eigen::MatrixXd half = modes.basis() * uncertainty;
  result.misfit =
      Misfit(result.replicate_covariance.matrix, result.noise.modes + half * half.transpose());
  return result;
}

double distance(const Estimates &estimates, const Modes &modes, const Eigen::VectorXd &deviation,
                const double leverage)
{
  return estimates.misfit.distance(estimates.misfit.coordinates(modes.basis() * deviation),
                                   leverage);
}

} // namespace

std::uint64_t held_out_runs(const MeasuredData &data, const StudyOptions &options,
                            const std::size_t n_nuisances)
{
  return (2ull * options.validate_runs + 2ull * nuisance_runs(options) * n_nuisances) *
         experiments_of(data.held_out).size();
}

HeldOut make_held_out(StudyState &study, const Amplitudes &chosen, const unsigned int times)
{
  const std::vector<MeasuredPoint> &points = study.data.held_out;
  const unsigned int number = times * study.options.validate_runs;
  const unsigned int of_nuisances = times * nuisance_runs(study.options);
  const Eigen::MatrixXd before = run_rows(study, {}, number);
  const Eigen::MatrixXd after =
      chosen.empty() ? Eigen::MatrixXd() : run_rows(study, chosen, number);
  HeldOut result;
  if (before.rows() < 3)
    return result;
  const Eigen::MatrixXd changes = nuisance_changes(study, of_nuisances);
  result.nuisance_variance =
      2. / static_cast<double>(of_nuisances) / std::pow(2. * nuisance_step, 2);
  const Eigen::VectorXd unit = units(points, before);
  std::vector<Eigen::Index> used;
  for (Eigen::Index c = 0; c < unit.size(); ++c)
    if (unit(c) > 0.)
      used.push_back(c);
  const auto n = static_cast<Eigen::Index>(used.size());
  result.data.resize(n);
  result.deviation.resize(n);
  result.repeats.resize(n);
  result.scale.resize(n);
  result.before.resize(before.rows(), n);
  result.after.resize(after.rows(), n);
  result.nuisances.resize(n, changes.cols());
  for (Eigen::Index c = 0; c < n; ++c) {
    const Eigen::Index from = used[static_cast<std::size_t>(c)];
    const MeasuredPoint &point = points[static_cast<std::size_t>(from)];
    result.points.push_back(point);
    result.scale(c) = unit(from);
    result.data(c) = point.value / unit(from);
    result.deviation(c) = point.standard_deviation / unit(from);
    result.repeats(c) = point.repeats;
    result.before.col(c) = before.col(from) / unit(from);
    if (after.rows() > 0)
      result.after.col(c) = after.col(from) / unit(from);
    result.nuisances.row(c) = changes.row(from) / unit(from);
  }
  return result;
}

Prediction predict(const StudyState &study, const HeldOut &held_out, const Eigen::MatrixXd &runs,
                   const Fit &fit, const double amplitude_error)
{
  Prediction result;
  result.runs = runs;
  result.is_of_base = fit.effects.empty();
  const Eigen::VectorXd mean = runs.colwise().mean().transpose();
  const Eigen::VectorXd estimates = nuisance_estimates(study, fit.remainder, fit.leverage);
  const Eigen::MatrixXd covariance = nuisance_covariance(study, fit.leverage);
  result.mean = mean + held_out.nuisances * estimates;
  result.leverage = 1. / static_cast<double>(runs.rows()) +
                    held_out.nuisance_variance * (estimates.squaredNorm() + covariance.trace());
  const Eigen::Index n = held_out.nuisances.cols();
  result.uncertainty = Eigen::MatrixXd::Zero(mean.size(), n + 1);
  if (n > 0) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(covariance);
    result.uncertainty.leftCols(n) = held_out.nuisances * eigen.eigenvectors() *
                                     eigen.eigenvalues().cwiseMax(0.).cwiseSqrt().asDiagonal();
  }
  // With another amplitude the estimates of the nuisances would be different.
  const Emulator emulator = study.emulator(fit.effects);
  const Eigen::VectorXd moved =
      nuisance_estimates(study, emulator.change(fit.position), fit.leverage);
  result.uncertainty.col(n) =
      amplitude_error *
      (mean - held_out.before.colwise().mean().transpose().eval() - held_out.nuisances * moved);
  return result;
}

Eigen::VectorXd noise_variance(const HeldOut &held_out, const Prediction &prediction)
{
  const Eigen::MatrixXd &runs = prediction.runs;
  const Eigen::VectorXd run_variance =
      centred(runs).colwise().squaredNorm().transpose() / static_cast<double>(runs.rows() - 1);
  return held_out.deviation.cwiseAbs2().cwiseQuotient(held_out.repeats) +
         run_variance * prediction.leverage + prediction.uncertainty.rowwise().squaredNorm();
}

double p_of_held_out(const HeldOut &held_out, const Prediction &prediction,
                     const std::uint32_t seed)
{
  constexpr int n_draws = 299;
  std::vector<DataPoint> points;
  for (const MeasuredPoint &point : held_out.points)
    points.push_back(point.point);
  const Eigen::Index n = held_out.data.size();
  const Modes modes(points, Eigen::VectorXd::Ones(n));
  const Eigen::MatrixXd &others = prediction.is_of_base ? held_out.after : held_out.before;
  const Estimates real = estimate(modes, prediction.runs, others,
                                  {held_out.deviation, held_out.repeats}, prediction.uncertainty);
  const double observed =
      distance(real, modes, held_out.data - prediction.mean, prediction.leverage);

  RandomStream random(seed, 3);
  const Eigen::MatrixXd lower =
      Eigen::LLT<Eigen::MatrixXd>(real.replicate_covariance.unshrunk).matrixL();
  const auto runs = [&](const Eigen::Index number) -> Eigen::MatrixXd {
    return random.normals(number, lower.rows()) * lower.transpose() * modes.basis();
  };
  const auto most_repeats = static_cast<Eigen::Index>(held_out.repeats.maxCoeff());
  const Eigen::ArrayXd ratio = real.noise.ratio.array();
  // Noise of the nuisances' changes, beside that of the model's own runs.
  const double further =
      std::max(0., prediction.leverage - 1. / static_cast<double>(prediction.runs.rows()));
  double beyond = 1.;
  for (int draw = 0; draw < n_draws; ++draw) {
    const Eigen::MatrixXd of_model = runs(prediction.runs.rows()), of_other = runs(others.rows());
    Eigen::MatrixXd rows = runs(most_repeats) * ratio.cwiseMin(1.).sqrt().matrix().asDiagonal();
    rows += random.normals(most_repeats, n) * (ratio - 1.).max(0.).sqrt().matrix().asDiagonal();
    Repeats repeats{held_out.deviation, held_out.repeats};
    Eigen::VectorXd data = prediction.uncertainty *
                           random.normals(1, prediction.uncertainty.cols()).row(0).transpose();
    for (Eigen::Index c = 0; c < n; ++c) {
      const auto number = static_cast<Eigen::Index>(held_out.repeats(c));
      const Eigen::VectorXd column = rows.col(c).head(number);
      data(c) += column.mean();
      if (number > 1)
        repeats.deviation(c) = std::sqrt((column.array() - column.mean()).square().sum() /
                                         static_cast<double>(number - 1));
    }
    const Estimates drawn = estimate(modes, of_model, of_other, repeats, prediction.uncertainty);
    const Eigen::VectorXd deviation = data - of_model.colwise().mean().transpose() +
                                      std::sqrt(further) * runs(1).row(0).transpose();
    beyond += distance(drawn, modes, deviation, prediction.leverage) >= observed ? 1. : 0.;
  }
  return beyond / (n_draws + 1.);
}

} // namespace eunoe::discovery
