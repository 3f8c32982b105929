#include <eunoe/core/problems.h>
#include <eunoe/discovery/stages/stages.h>

#include <algorithm>
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
  const Eigen::VectorXd deviation = (centred(rows).colwise().squaredNorm().transpose() /
                                     static_cast<double>(rows.rows() - 1))
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

/// Chaos of modes and cells, and the noise of the data.
void settle_chaos(Workbench &bench)
{
  const auto runs = static_cast<Eigen::Index>(bench.base().size());
  Eigen::MatrixXd rows(runs, bench.modes.n_modes()), cells(runs, bench.modes.n_cells());
  for (Eigen::Index r = 0; r < runs; ++r) {
    const RunSet &run = bench.base()[static_cast<std::size_t>(r)];
    rows.row(r) = run.modes.transpose();
    cells.row(r) = bench.measured(run.values)
                       .cwiseQuotient(bench.modes.deviations())
                       .transpose();
  }
  bench.chaos = shrunk_covariance(centred(rows), static_cast<double>(runs - 1),
                                  bench.modes.experiment_of_mode());
  // Modes that hardly vary are no better known than the cells that they are made of.
  bench.chaos.matrix.diagonal() += Eigen::VectorXd::Constant(bench.modes.n_modes(), 1e-3);
  bench.cell_chaos = (centred(cells).colwise().squaredNorm().transpose() /
                      static_cast<double>(runs - 1))
                         .cwiseMax(0.04);
  bench.noise = estimate_data_noise(
      bench.modes, bench.chaos.matrix, bench.cell_chaos,
      {bench.deviation.cwiseQuotient(bench.modes.deviations()), bench.repeats});
}

Eigen::VectorXd mean_at(const Workbench &bench, const Amplitudes &amplitudes)
{
  const auto &sets = bench.runs.at(amplitudes);
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(bench.modes.n_cells());
  for (const RunSet &set : sets)
    mean += bench.measured(set.values) / static_cast<double>(sets.size());
  return mean;
}

/// Changes of the cells by one prior deviation of each nuisance, from runs on both sides or, where
/// one side fails, on one.
void settle_nuisances(Workbench &bench)
{
  bench.nuisance_cells =
      Eigen::MatrixXd::Zero(bench.modes.n_cells(),
                            static_cast<Eigen::Index>(bench.nuisances.size()));
  for (std::size_t k = 0; k < bench.nuisances.size(); ++k) {
    const Factor &nuisance = bench.nuisances[k];
    const Amplitudes up = {{nuisance.name, nuisance.null_value + nuisance.prior_deviation}};
    const Amplitudes down = {{nuisance.name, nuisance.null_value - nuisance.prior_deviation}};
    const bool has_up = !bench.runs[up].empty(), has_down = !bench.runs[down].empty();
    if (!has_up && !has_down) {
      bench.notes.push_back("The nuisance " + nuisance.name +
                            " could not be simulated and is not profiled out.");
      continue;
    }
    const Eigen::VectorXd change =
        mean_at(bench, has_up ? up : Amplitudes()) - mean_at(bench, has_down ? down : Amplitudes());
    bench.nuisance_cells.col(static_cast<Eigen::Index>(k)) =
        change.cwiseQuotient(bench.modes.deviations()) / (has_up && has_down ? 2. : 1.);
    const auto variance = [&](const Amplitudes &amplitudes) {
      return 1. / static_cast<double>(bench.runs.at(amplitudes).size());
    };
    bench.nuisance_noise += has_up && has_down
                                ? 0.25 * (variance(up) + variance(down))
                                : variance(has_up ? up : down) + variance({});
  }
}

} // namespace

Table stage_null(Workbench &bench)
{
  bench.column_of_cell = places(bench);
  std::vector<Workbench::Order> orders = {{{}, bench.options.null_runs}};
  for (const Factor &nuisance : bench.nuisances)
    for (const double side : {1., -1.})
      orders.push_back(
          {{{nuisance.name, nuisance.null_value + side * nuisance.prior_deviation}},
           bench.options.nuisance_runs});
  bench.ask(orders);
  if (bench.base().size() < 8)
    throw UserError("Only " + std::to_string(bench.base().size()) + " of " +
                    std::to_string(bench.options.null_runs) +
                    " sets of runs of the base model came to their end, and at least 8 are needed: "
                    "raise the budget, or see why runs fail.");
  settle_cells(bench);
  settle_chaos(bench);
  settle_nuisances(bench);
  bench.misfit = Misfit(bench.chaos.matrix, bench.other_covariance(bench.noise, bench.chaos.matrix));

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
