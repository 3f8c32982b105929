#include <eunoe/discovery/stages/stages.h>
#include <eunoe/discovery/statistics/random_stream.h>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

namespace {

/// Held-out data beside runs of the base model and of the chosen one, in units of a cell's chaos.
struct HeldOut
{
  std::vector<MeasuredCell> cells;
  Eigen::VectorXd data, deviation, repeats, scale;
  Eigen::MatrixXd before, after; ///< runs x cells
};

/// Runs of all held-out experiments, one row a seed for which all came to their end.
Eigen::MatrixXd run_rows(Workbench &bench, const std::vector<MeasuredCell> &cells,
                         const Amplitudes &amplitudes)
{
  std::vector<std::string> experiments;
  for (const MeasuredCell &cell : cells)
    if (std::find(experiments.begin(), experiments.end(), cell.cell.experiment) ==
        experiments.end())
      experiments.push_back(cell.cell.experiment);
  std::vector<RunRequest> requests;
  for (unsigned int k = 0; k < bench.options.validate_runs; ++k)
    for (const std::string &experiment : experiments)
      requests.push_back({experiment, amplitudes, 100000u * bench.options.seed + 1u + k});
  if (requests.size() > bench.archive.remaining())
    return {};
  const std::vector<RunResult> results = bench.archive.get(requests);
  std::vector<Eigen::VectorXd> rows;
  for (unsigned int k = 0; k < bench.options.validate_runs; ++k) {
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

/// Divides all by each cell's chaos; cells without any are left out.
HeldOut in_units_of_chaos(const std::vector<MeasuredCell> &cells, const Eigen::MatrixXd &before,
                          const Eigen::MatrixXd &after)
{
  const Eigen::VectorXd chaos = (centred(before).colwise().squaredNorm().transpose() /
                                 static_cast<double>(before.rows() - 1))
                                    .cwiseSqrt();
  HeldOut result;
  std::vector<Eigen::Index> used;
  std::vector<double> scales;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const auto k = static_cast<Eigen::Index>(c);
    double typical = 0., number = 0.;
    for (std::size_t d = 0; d < cells.size(); ++d)
      if (cells[d].cell.experiment == cells[c].cell.experiment &&
          cells[d].cell.observable == cells[c].cell.observable) {
        typical += chaos(static_cast<Eigen::Index>(d));
        number += 1.;
      }
    const double scale = std::max(
        {chaos(k), 0.3 * typical / number, 0.3 * cells[c].standard_deviation});
    if (scale <= 0.)
      continue;
    used.push_back(k);
    scales.push_back(scale);
    result.cells.push_back(cells[c]);
  }
  const auto n = static_cast<Eigen::Index>(used.size());
  result.data.resize(n);
  result.deviation.resize(n);
  result.repeats.resize(n);
  result.scale = Eigen::Map<Eigen::VectorXd>(scales.data(), n);
  result.before.resize(before.rows(), n);
  result.after.resize(after.rows(), n);
  for (Eigen::Index c = 0; c < n; ++c) {
    const MeasuredCell &cell = result.cells[static_cast<std::size_t>(c)];
    const double scale = result.scale(c);
    result.data(c) = cell.value / scale;
    result.deviation(c) = cell.standard_deviation / scale;
    result.repeats(c) = cell.repeats;
    result.before.col(c) = before.col(used[static_cast<std::size_t>(c)]) / scale;
    if (after.rows() > 0)
      result.after.col(c) = after.col(used[static_cast<std::size_t>(c)]) / scale;
  }
  return result;
}

/// Variance of each cell's deviation between data and the mean of some runs.
Eigen::VectorXd noise_variance(const HeldOut &held_out, const Eigen::MatrixXd &runs)
{
  const Eigen::VectorXd chaos = centred(runs).colwise().squaredNorm().transpose() /
                                static_cast<double>(runs.rows() - 1);
  return held_out.deviation.cwiseAbs2().cwiseQuotient(held_out.repeats) +
         chaos / static_cast<double>(runs.rows());
}

Eigen::VectorXd mean_of(const Eigen::MatrixXd &rows)
{
  return rows.colwise().mean().transpose();
}

Eigen::VectorXd resampled_mean(const Eigen::MatrixXd &rows, RandomStream &random)
{
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(rows.cols());
  for (Eigen::Index r = 0; r < rows.rows(); ++r)
    mean += rows.row(static_cast<Eigen::Index>(random.index(static_cast<std::size_t>(rows.rows()))))
                .transpose() /
            static_cast<double>(rows.rows());
  return mean;
}

/// Noise of the data's means, with the correlations that runs show.
Eigen::VectorXd data_jitter(const HeldOut &held_out, RandomStream &random)
{
  const Eigen::MatrixXd rows = centred(held_out.before);
  const auto number = static_cast<Eigen::Index>(std::max(1., held_out.repeats.mean() + 0.5));
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(rows.cols());
  for (Eigen::Index k = 0; k < number; ++k)
    sum += rows.row(static_cast<Eigen::Index>(random.index(static_cast<std::size_t>(rows.rows()))))
               .transpose() /
           static_cast<double>(number);
  return sum.cwiseProduct(held_out.deviation);
}

/// Where the data lie between the two models: 0 at the base model, 1 at the chosen one; below a
/// half the gap grows.
struct Progress
{
  double value = 0., error = 1e300;
};

Progress progress(const HeldOut &held_out)
{
  const Eigen::VectorXd before = mean_of(held_out.before);
  const Eigen::VectorXd change = mean_of(held_out.after) - before;
  const Eigen::MatrixXd chaos = centred(held_out.before), chaos_after = centred(held_out.after);
  const auto m = static_cast<double>(chaos.rows()), n = static_cast<double>(chaos_after.rows());
  const double noise = chaos.squaredNorm() / (m - 1.) / m + chaos_after.squaredNorm() / (n - 1.) / n;
  const double square = change.squaredNorm() - noise;
  if (square <= 0.)
    return {};
  const double along = (chaos * change).squaredNorm() / (m - 1.);
  const double ratio = std::max(0.3, held_out.deviation.cwiseAbs2().mean());
  const double variance = along * (ratio / held_out.repeats.mean() + 1. / m);
  // The base runs' own noise is in both factors.
  const double bias = chaos.squaredNorm() / (m - 1.) / m;
  return {(change.dot(held_out.data - before) - bias) / square, std::sqrt(variance) / square};
}

Table quantiles(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  return {at(0.025), at(0.975)};
}

Table compare(const Workbench &bench, const HeldOut &held_out)
{
  constexpr int n_draws = 999;
  const bool has_after = held_out.after.rows() >= 3;
  const Eigen::VectorXd noise = noise_variance(held_out, held_out.before);
  const Gap before = gap(held_out.data - mean_of(held_out.before), noise);
  Table table = {{"cells", held_out.cells.size()},
                 {"gap before", before.value},
                 {"deviation before", before.before_correction}};
  if (!has_after)
    return table;
  const Eigen::VectorXd noise_after = noise_variance(held_out, held_out.after);
  const Gap after = gap(held_out.data - mean_of(held_out.after), noise_after);
  table["gap after"] = after.value;
  table["deviation after"] = after.before_correction;
  table["shrink"] = before.value > 0. ? Table(1. - after.value / before.value) : Table(nullptr);

  RandomStream random(bench.options.seed, 2);
  std::vector<double> gaps_before, gaps_after, shrinks;
  for (int d = 0; d < n_draws; ++d) {
    const Eigen::VectorXd data = held_out.data + data_jitter(held_out, random);
    // A draw adds the noise once more.
    const double b = gap(data - resampled_mean(held_out.before, random), 2. * noise).value;
    const double a = gap(data - resampled_mean(held_out.after, random), 2. * noise_after).value;
    gaps_before.push_back(b);
    gaps_after.push_back(a);
    shrinks.push_back(b > 0. ? 1. - a / b : a > 0. ? -1e3 : 0.);
  }
  table["gap before interval"] = quantiles(gaps_before);
  table["gap after interval"] = quantiles(gaps_after);
  table["shrink interval"] = quantiles(shrinks);
  return table;
}

Table describe_cells(const HeldOut &held_out)
{
  const auto spread = [](const Eigen::MatrixXd &rows, Eigen::Index c) {
    return std::sqrt(centred(rows).col(c).squaredNorm() / static_cast<double>(rows.rows() - 1));
  };
  Table rows = Table::array();
  for (std::size_t k = 0; k < held_out.cells.size(); ++k) {
    const auto c = static_cast<Eigen::Index>(k);
    const MeasuredCell &cell = held_out.cells[k];
    Table row = {{"experiment", cell.cell.experiment},
                 {"observable", cell.cell.observable},
                 {"index", cell.cell.index},
                 {"measured", cell.value},
                 {"measured deviation", cell.standard_deviation},
                 {"repeats", cell.repeats},
                 {"base", held_out.before.col(c).mean() * held_out.scale(c)},
                 {"base deviation", spread(held_out.before, c) * held_out.scale(c)}};
    if (held_out.after.rows() > 1) {
      row["after"] = held_out.after.col(c).mean() * held_out.scale(c);
      row["after deviation"] = spread(held_out.after, c) * held_out.scale(c);
    }
    rows.push_back(row);
  }
  return rows;
}

} // namespace

Table stage_validate(Workbench &bench, Findings &findings)
{
  if (bench.data.held_out.empty())
    return {{"result", "no held-out data"}};
  bench.archive.set_aside(0);
  const Eigen::MatrixXd before = run_rows(bench, bench.data.held_out, {});
  const Fit &fit = findings.chosen.fit;
  Eigen::MatrixXd after;
  if (!fit.effects.empty())
    after = run_rows(bench, bench.data.held_out, bench.amplitudes(fit.effects, fit.position));
  if (before.rows() < 3)
    return {{"result", "too few runs of the held-out experiments came to their end"}};
  const HeldOut held_out = in_units_of_chaos(bench.data.held_out, before, after);
  if (held_out.cells.empty())
    return {{"result", "no held-out cell varies"}};

  Table table = compare(bench, held_out);
  table["envelopes"] = describe_cells(held_out);
  if (after.rows() < 3) {
    table["result"] = fit.effects.empty() ? "base model only" : "runs of the model with the "
                                                                "effect failed";
    return table;
  }
  // Between the models, with one standard error against the name: shrinks are rarely so unlucky.
  const Progress between = progress(held_out);
  const bool informative = between.error < 0.5;
  findings.withdrawn = informative && between.value < 0.5 - between.error;
  table["position between the models"] = informative ? Table(between.value) : Table(nullptr);
  table["standard error of the position"] = informative ? Table(between.error) : Table(nullptr);
  table["result"] = !informative          ? "held-out data cannot tell the two models apart"
                    : findings.withdrawn ? "the gap does not shrink: the name is withdrawn"
                                         : "the gap shrinks";
  return table;
}

} // namespace eunoe::discovery
