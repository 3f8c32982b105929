#include <eunoe/core/problems.h>
#include <eunoe/discovery/stages/stages.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace eunoe::discovery {

namespace {

/// Standard deviation of each cell in the runs of the base model. Cells that hardly vary get a
/// share of their observable's typical deviation, so that a last digit is no discovery; 0 for cells
/// of which nothing is known to vary.
Eigen::VectorXd chaos_of_cells(const Workbench &bench, const std::vector<MeasuredCell> &data)
{
  constexpr double least_share = 0.2;
  const auto n = static_cast<Eigen::Index>(bench.cells.size());
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(bench.base().size()), n);
  for (std::size_t r = 0; r < bench.base().size(); ++r)
    rows.row(static_cast<Eigen::Index>(r)) = bench.measured(bench.base()[r].values).transpose();
  const Eigen::VectorXd deviation =
      (centred(rows).colwise().squaredNorm().transpose() / static_cast<double>(rows.rows() - 1))
          .cwiseSqrt();
  Eigen::VectorXd result = deviation;
  for (Eigen::Index c = 0; c < n; ++c) {
    std::vector<double> same;
    for (Eigen::Index d = 0; d < n; ++d) {
      const Cell &a = bench.cells[static_cast<std::size_t>(c)];
      const Cell &b = bench.cells[static_cast<std::size_t>(d)];
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

std::vector<Eigen::Index> places(const Workbench &bench)
{
  std::vector<Eigen::Index> result;
  for (const Cell &cell : bench.cells)
    result.push_back(std::find(bench.columns.begin(), bench.columns.end(), cell) -
                     bench.columns.begin());
  return result;
}

/// Leaves out cells that cannot be compared, and fixes values, units and order of the rest.
void settle_cells(Workbench &bench)
{
  std::vector<MeasuredCell> data = bench.data.fit;
  const Eigen::VectorXd all = chaos_of_cells(bench, data);
  std::vector<MeasuredCell> used;
  std::vector<double> deviations;
  for (std::size_t c = 0; c < data.size(); ++c) {
    const double deviation = all(static_cast<Eigen::Index>(c));
    if (deviation > 0.) {
      used.push_back(data[c]);
      deviations.push_back(deviation);
    } else {
      bench.notes.push_back("Left out, as it varies neither in runs nor in the measurement: " +
                            data[c].cell.experiment + ", " + data[c].cell.observable + ", index " +
                            std::to_string(data[c].cell.index) + ".");
    }
  }
  if (used.empty())
    throw UserError("No measured cell varies in the runs of the base model, so nothing can be "
                    "compared: give standard deviations, or cells that vary.");
  const auto n = static_cast<Eigen::Index>(used.size());
  bench.cells.clear();
  bench.value.resize(n);
  bench.deviation.resize(n);
  bench.repeats.resize(n);
  for (Eigen::Index c = 0; c < n; ++c) {
    const MeasuredCell &cell = used[static_cast<std::size_t>(c)];
    bench.cells.push_back(cell.cell);
    bench.value(c) = cell.value;
    bench.deviation(c) = cell.standard_deviation;
    bench.repeats(c) = cell.repeats;
  }
  bench.column_of_cell = places(bench);
  bench.settle_modes(Modes(bench.cells, Eigen::Map<Eigen::VectorXd>(deviations.data(), n)));
}

/// A nuisance's values on both sides. Two prior deviations make a clearer change than one, and are
/// mostly little enough to be in proportion.
std::array<double, 2> nuisance_values(const Factor &nuisance)
{
  constexpr double step = 2.;
  return {std::max(nuisance.lower, nuisance.null_value - step * nuisance.prior_deviation),
          std::min(nuisance.upper, nuisance.null_value + step * nuisance.prior_deviation)};
}

/// Changes of the cells by one prior deviation of a nuisance: a row for each seed with runs on both
/// sides; where the sides have no seeds in common, for each pair of their runs; and where one side
/// fails, for each run on the other with a seed of the base model.
Eigen::MatrixXd changes_by(Workbench &bench, const Factor &nuisance)
{
  const auto [low, high] = nuisance_values(nuisance);
  const auto &up = bench.runs[{{nuisance.name, high}}], &down = bench.runs[{{nuisance.name, low}}];
  std::vector<Eigen::VectorXd> rows;
  const auto add = [&](const RunSet &a, const RunSet &b, double step, bool is_pair) {
    if (is_pair && step > 0.)
      rows.push_back((bench.measured(a.values) - bench.measured(b.values)) *
                     (nuisance.prior_deviation / step));
  };
  for (const RunSet &a : up)
    for (const RunSet &b : down)
      add(a, b, high - low, a.seed == b.seed);
  if (rows.size() < 2)
    for (std::size_t k = 0; k < std::min(up.size(), down.size()); ++k)
      add(up[k], down[k], high - low, up[k].seed != down[k].seed);
  if (rows.size() < 2)
    for (const RunSet &base : bench.base()) {
      for (const RunSet &run : up)
        add(run, base, high - nuisance.null_value, run.seed == base.seed);
      for (const RunSet &run : down)
        add(base, run, nuisance.null_value - low, run.seed == base.seed);
    }
  Eigen::MatrixXd result(static_cast<Eigen::Index>(rows.size()), bench.modes.n_cells());
  for (std::size_t r = 0; r < rows.size(); ++r)
    result.row(static_cast<Eigen::Index>(r)) =
        rows[r].cwiseQuotient(bench.modes.deviations()).transpose();
  return result;
}

/// What is known of each nuisance's change, and the noise that stays in it, which counts as noise
/// of the comparison.
void settle_nuisances(Workbench &bench)
{
  const Misfit white(bench.chaos.matrix, 0. * bench.chaos.matrix);
  bench.nuisance_noise = 0.;
  bench.nuisance_cells = Eigen::MatrixXd::Zero(bench.modes.n_cells(),
                                               static_cast<Eigen::Index>(bench.nuisances.size()));
  for (std::size_t k = 0; k < bench.nuisances.size(); ++k) {
    const Eigen::MatrixXd rows = changes_by(bench, bench.nuisances[k]);
    if (rows.rows() < 2) {
      bench.notes.push_back("The nuisance " + bench.nuisances[k].name +
                            " could not be simulated and is not profiled out.");
      continue;
    }
    const auto number = static_cast<double>(rows.rows());
    bench.nuisance_cells.col(static_cast<Eigen::Index>(k)) = rows.colwise().mean().transpose();
    bench.nuisance_noise +=
        white.coordinates(bench.modes.basis() * centred(rows).transpose()).squaredNorm() /
        ((number - 1.) * number * static_cast<double>(bench.modes.n_modes()));
  }
}

} // namespace

void ask_base_runs(Workbench &bench, const unsigned int base, const unsigned int nuisance)
{
  std::vector<Workbench::Order> orders = {{{}, base}};
  for (const Factor &factor : bench.nuisances)
    for (const double value : nuisance_values(factor))
      orders.push_back({{{factor.name, value}}, nuisance});
  bench.ask(orders);
}

void settle_noise(Workbench &bench)
{
  settle_chaos(bench);
  settle_nuisances(bench);
  settle_chaos(bench);
}

Table stage_null(Workbench &bench)
{
  bench.column_of_cell = places(bench);
  ask_base_runs(bench, bench.options.null_runs, bench.options.nuisance_runs);
  if (bench.base().size() < 8)
    throw UserError("Only " + std::to_string(bench.base().size()) + " of " +
                    std::to_string(bench.options.null_runs) +
                    " sets of runs of the base model came to their end, and at least 8 are needed: "
                    "raise the budget, or see why runs fail.");
  settle_cells(bench);
  settle_noise(bench);

  Table table = {{"base runs", bench.base().size()},
                 {"cells", bench.cells.size()},
                 {"modes", bench.modes.n_modes()},
                 {"shrinkage of correlations", bench.chaos.shrinkage}};
  table["variance of a repeat over that of a run"] = Table::array();
  for (const Modes::Group &group : bench.modes.groups())
    table["variance of a repeat over that of a run"].push_back(
        {{"experiment", group.experiment},
         {"observable", group.observable},
         {"ratio", bench.noise.ratio(group.cells.front())}});
  return table;
}

} // namespace eunoe::discovery
