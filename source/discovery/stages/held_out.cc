#include <eunoe/discovery/stages/held_out.h>
#include <eunoe/discovery/stages/stages.h>
#include <eunoe/discovery/statistics/random_stream.h>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

namespace {

/// Prior deviations by which a nuisance is moved to either side, as in the stage null.
constexpr double nuisance_step = 2.;

std::vector<std::string> experiments_of(const std::vector<MeasuredCell> &cells)
{
  std::vector<std::string> experiments;
  for (const MeasuredCell &cell : cells)
    if (std::find(experiments.begin(), experiments.end(), cell.cell.experiment) ==
        experiments.end())
      experiments.push_back(cell.cell.experiment);
  return experiments;
}

/// Few are enough, as both sides together tell the change by one prior deviation with a sixteenth
/// of one run's variance.
unsigned int nuisance_runs(const StudyOptions &options)
{
  return std::max(1u, options.nuisance_runs / 2);
}

/// Runs of all held-out experiments, one row a seed for which all came to their end.
Eigen::MatrixXd run_rows(Workbench &bench, const Amplitudes &amplitudes, const unsigned int number)
{
  const std::vector<MeasuredCell> &cells = bench.data.held_out;
  const std::vector<std::string> experiments = experiments_of(cells);
  std::vector<RunRequest> requests;
  for (unsigned int k = 0; k < number; ++k)
    for (const std::string &experiment : experiments)
      requests.push_back({experiment, amplitudes, 100000u * bench.options.seed + 1u + k});
  if (requests.size() > bench.archive.remaining())
    return {};
  const std::vector<RunResult> results = bench.archive.get(requests);
  std::vector<Eigen::VectorXd> rows;
  for (unsigned int k = 0; k < number; ++k) {
    Eigen::VectorXd row(static_cast<Eigen::Index>(cells.size()));
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const auto e = static_cast<std::size_t>(
          std::find(experiments.begin(), experiments.end(), cells[c].cell.experiment) -
          experiments.begin());
      const RunResult &result = results[k * experiments.size() + e];
      const auto &known = bench.archive.laboratory().cells(cells[c].cell.experiment);
      const auto place = std::find(known.begin(), known.end(), cells[c].cell) - known.begin();
      row(static_cast<Eigen::Index>(c)) =
          result ? (*result)[static_cast<std::size_t>(place)] : std::nan("");
    }
    if (row.allFinite())
      rows.push_back(row);
  }
  Eigen::MatrixXd matrix(static_cast<Eigen::Index>(rows.size()),
                         static_cast<Eigen::Index>(cells.size()));
  for (std::size_t r = 0; r < rows.size(); ++r)
    matrix.row(static_cast<Eigen::Index>(r)) = rows[r].transpose();
  return matrix;
}

/// Changes of all held-out cells by one prior deviation of each nuisance; none where a side failed.
Eigen::MatrixXd nuisance_changes(Workbench &bench, const unsigned int number)
{
  Eigen::MatrixXd changes =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(bench.data.held_out.size()),
                            static_cast<Eigen::Index>(bench.nuisances.size()));
  for (std::size_t k = 0; k < bench.nuisances.size(); ++k) {
    const Factor &nuisance = bench.nuisances[k];
    const double low =
        std::max(nuisance.lower, nuisance.null_value - nuisance_step * nuisance.prior_deviation);
    const double high =
        std::min(nuisance.upper, nuisance.null_value + nuisance_step * nuisance.prior_deviation);
    const Eigen::MatrixXd up = run_rows(bench, {{nuisance.name, high}}, number);
    const Eigen::MatrixXd down = run_rows(bench, {{nuisance.name, low}}, number);
    if (up.rows() > 0 && down.rows() > 0)
      changes.col(static_cast<Eigen::Index>(k)) =
          (up.colwise().mean() - down.colwise().mean()).transpose() *
          (nuisance.prior_deviation / (high - low));
    else
      bench.notes.push_back("The nuisance " + nuisance.name +
                            " could not be simulated in the held-out experiments and is not "
                            "profiled out there.");
  }
  return changes;
}

/// Unit of each cell: its chaos, or where that is nothing a share of its observable's or of the
/// measurement's deviation.
Eigen::VectorXd units(const std::vector<MeasuredCell> &cells, const Eigen::MatrixXd &before)
{
  const Eigen::VectorXd chaos =
      (centred(before).colwise().squaredNorm().transpose() / static_cast<double>(before.rows() - 1))
          .cwiseSqrt();
  Eigen::VectorXd result(chaos.size());
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const auto k = static_cast<Eigen::Index>(c);
    double typical = 0., number = 0.;
    for (std::size_t d = 0; d < cells.size(); ++d)
      if (cells[d].cell.experiment == cells[c].cell.experiment &&
          cells[d].cell.observable == cells[c].cell.observable)
      {
        typical += chaos(static_cast<Eigen::Index>(d));
        number += 1.;
      }
    result(k) = std::max({chaos(k), 0.3 * typical / number, 0.3 * cells[c].standard_deviation});
  }
  return result;
}

/// Statistics of held-out cells that are estimated from runs and repeats.
struct Estimates
{
  Misfit misfit;
  Covariance chaos;
  DataNoise noise;
};

/// @param others runs of another model, which tell of the chaos too, once their own size of it is
///   taken off; or none
Estimates estimate(const Modes &modes, const Eigen::MatrixXd &runs, const Eigen::MatrixXd &others,
                   const Repeats &repeats, const Eigen::MatrixXd &doubt)
{
  Eigen::MatrixXd cells(runs.rows() + others.rows(), runs.cols());
  cells.topRows(runs.rows()) = centred(runs);
  if (others.rows() > 0) {
    const Eigen::MatrixXd deviations = centred(others);
    const double own =
        cells.topRows(runs.rows()).squaredNorm() / static_cast<double>(runs.rows() - 1);
    const double theirs = deviations.squaredNorm() / static_cast<double>(others.rows() - 1);
    cells.bottomRows(others.rows()) = deviations * (theirs > 0. ? std::sqrt(own / theirs) : 1.);
  }
  const auto dof = static_cast<double>(cells.rows() - (others.rows() > 0 ? 2 : 1));
  Estimates result;
  result.chaos =
      shrunk_covariance(cells * modes.basis().transpose(), dof, modes.experiment_of_mode());
  result.chaos.matrix.diagonal().array() += 1e-3;
  const Eigen::VectorXd cell_chaos =
      (cells.colwise().squaredNorm().transpose() / dof).cwiseMax(0.04);
  result.noise = estimate_data_noise(modes, result.chaos.matrix, cell_chaos, repeats);
  const Eigen::MatrixXd half = modes.basis() * doubt;
  result.misfit = Misfit(result.chaos.matrix, result.noise.modes + half * half.transpose());
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

HeldOut make_held_out(Workbench &bench, const Amplitudes &chosen, const unsigned int times)
{
  const std::vector<MeasuredCell> &cells = bench.data.held_out;
  const unsigned int number = times * bench.options.validate_runs;
  const unsigned int of_nuisances = times * nuisance_runs(bench.options);
  const Eigen::MatrixXd before = run_rows(bench, {}, number);
  const Eigen::MatrixXd after =
      chosen.empty() ? Eigen::MatrixXd() : run_rows(bench, chosen, number);
  HeldOut result;
  if (before.rows() < 3)
    return result;
  const Eigen::MatrixXd changes = nuisance_changes(bench, of_nuisances);
  result.nuisance_variance =
      2. / static_cast<double>(of_nuisances) / std::pow(2. * nuisance_step, 2);
  const Eigen::VectorXd unit = units(cells, before);
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
    const MeasuredCell &cell = cells[static_cast<std::size_t>(from)];
    result.cells.push_back(cell);
    result.scale(c) = unit(from);
    result.data(c) = cell.value / unit(from);
    result.deviation(c) = cell.standard_deviation / unit(from);
    result.repeats(c) = cell.repeats;
    result.before.col(c) = before.col(from) / unit(from);
    if (after.rows() > 0)
      result.after.col(c) = after.col(from) / unit(from);
    result.nuisances.row(c) = changes.row(from) / unit(from);
  }
  return result;
}

Prediction predict(const Workbench &bench, const HeldOut &held_out, const Eigen::MatrixXd &runs,
                   const Fit &fit, const double amplitude_error)
{
  Prediction result;
  result.runs = runs;
  result.is_of_base = fit.effects.empty();
  const Eigen::VectorXd mean = runs.colwise().mean().transpose();
  const Eigen::VectorXd estimates = nuisance_estimates(bench, fit.remainder, fit.leverage);
  const Eigen::MatrixXd covariance = nuisance_covariance(bench, fit.leverage);
  result.mean = mean + held_out.nuisances * estimates;
  result.leverage = 1. / static_cast<double>(runs.rows()) +
                    held_out.nuisance_variance * (estimates.squaredNorm() + covariance.trace());
  const Eigen::Index n = held_out.nuisances.cols();
  result.doubt = Eigen::MatrixXd::Zero(mean.size(), n + 1);
  if (n > 0) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(covariance);
    result.doubt.leftCols(n) = held_out.nuisances * eigen.eigenvectors() *
                               eigen.eigenvalues().cwiseMax(0.).cwiseSqrt().asDiagonal();
  }
  // With another amplitude the data of the fit would have the nuisances elsewhere.
  const Response response = bench.response(fit.effects);
  const Eigen::VectorXd moved =
      nuisance_estimates(bench, response.change(fit.position), fit.leverage);
  result.doubt.col(n) =
      amplitude_error *
      (mean - held_out.before.colwise().mean().transpose().eval() - held_out.nuisances * moved);
  return result;
}

Eigen::VectorXd noise_variance(const HeldOut &held_out, const Prediction &prediction)
{
  const Eigen::MatrixXd &runs = prediction.runs;
  const Eigen::VectorXd chaos =
      centred(runs).colwise().squaredNorm().transpose() / static_cast<double>(runs.rows() - 1);
  return held_out.deviation.cwiseAbs2().cwiseQuotient(held_out.repeats) +
         chaos * prediction.leverage + prediction.doubt.rowwise().squaredNorm();
}

double p_of_held_out(const HeldOut &held_out, const Prediction &prediction,
                     const std::uint32_t seed)
{
  constexpr int n_draws = 299;
  std::vector<Cell> cells;
  for (const MeasuredCell &cell : held_out.cells)
    cells.push_back(cell.cell);
  const Eigen::Index n = held_out.data.size();
  const Modes modes(cells, Eigen::VectorXd::Ones(n));
  const Eigen::MatrixXd &others = prediction.is_of_base ? held_out.after : held_out.before;
  const Estimates real = estimate(modes, prediction.runs, others,
                                  {held_out.deviation, held_out.repeats}, prediction.doubt);
  const double observed =
      distance(real, modes, held_out.data - prediction.mean, prediction.leverage);

  RandomStream random(seed, 3);
  const Eigen::MatrixXd lower = Eigen::LLT<Eigen::MatrixXd>(real.chaos.unshrunk).matrixL();
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
    Eigen::VectorXd data =
        prediction.doubt * random.normals(1, prediction.doubt.cols()).row(0).transpose();
    for (Eigen::Index c = 0; c < n; ++c) {
      const auto number = static_cast<Eigen::Index>(held_out.repeats(c));
      const Eigen::VectorXd column = rows.col(c).head(number);
      data(c) += column.mean();
      if (number > 1)
        repeats.deviation(c) = std::sqrt((column.array() - column.mean()).square().sum() /
                                         static_cast<double>(number - 1));
    }
    const Estimates drawn = estimate(modes, of_model, of_other, repeats, prediction.doubt);
    const Eigen::VectorXd deviation = data - of_model.colwise().mean().transpose() +
                                      std::sqrt(further) * runs(1).row(0).transpose();
    beyond += distance(drawn, modes, deviation, prediction.leverage) >= observed ? 1. : 0.;
  }
  return beyond / (n_draws + 1.);
}

} // namespace eunoe::discovery
