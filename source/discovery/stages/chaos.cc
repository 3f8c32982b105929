#include <eunoe/discovery/stages/stages.h>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

namespace {

/// Modes of all sets of runs of one kind less their mean, a row each.
Eigen::MatrixXd deviations_of(const std::vector<RunSet> &sets)
{
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(sets.size()), sets.front().modes.size());
  for (std::size_t r = 0; r < sets.size(); ++r)
    rows.row(static_cast<Eigen::Index>(r)) = sets[r].modes.transpose();
  return centred(rows);
}

} // namespace

void settle_chaos(Workbench &bench)
{
  const Eigen::MatrixXd base = deviations_of(bench.base());
  const auto base_dof = static_cast<double>(base.rows() - 1);
  const Eigen::VectorXd variance =
      (base.colwise().squaredNorm().transpose() / base_dof).cwiseMax(1e-6);

  // Repeated runs of other models say as much of the chaos, once their own size of it is taken off:
  // there are many more of them than runs of the base model.
  std::vector<Eigen::MatrixXd> groups = {base};
  double dof = base_dof;
  Eigen::Index n_rows = base.rows();
  for (const auto &[amplitudes, sets] : bench.runs) {
    if (amplitudes.empty() || sets.size() < 2)
      continue;
    const Eigen::MatrixXd rows = deviations_of(sets);
    const auto own = static_cast<double>(rows.rows() - 1);
    const double ratio =
        (rows.colwise().squaredNorm().transpose().array() / variance.array()).mean() / own;
    if (!(ratio > 0.))
      continue;
    groups.push_back(rows / std::sqrt(ratio));
    dof += own;
    n_rows += rows.rows();
  }
  Eigen::MatrixXd all(n_rows, base.cols());
  Eigen::Index row = 0;
  for (const Eigen::MatrixXd &group : groups) {
    all.middleRows(row, group.rows()) = group;
    row += group.rows();
  }
  bench.chaos = shrunk_covariance(all, dof, bench.modes.experiment_of_mode());
  bench.chaos_degrees_of_freedom = dof;
  // Modes that hardly vary are no better known than the cells that they are made of.
  bench.chaos.matrix.diagonal().array() += 1e-3;

  Eigen::MatrixXd cells(base.rows(), bench.modes.n_cells());
  for (Eigen::Index r = 0; r < cells.rows(); ++r)
    cells.row(r) = bench.measured(bench.base()[static_cast<std::size_t>(r)].values)
                       .cwiseQuotient(bench.modes.deviations())
                       .transpose();
  bench.cell_chaos = (centred(cells).colwise().squaredNorm().transpose() / base_dof).cwiseMax(0.04);
  bench.noise =
      estimate_data_noise(bench.modes, bench.chaos.matrix, bench.cell_chaos,
                          {bench.deviation.cwiseQuotient(bench.modes.deviations()), bench.repeats});
  const Misfit::Tail tail = bench.misfit.tail;
  bench.misfit =
      Misfit(bench.chaos.matrix, bench.other_covariance(bench.noise, bench.chaos.matrix));
  bench.misfit.tail = tail;
}

} // namespace eunoe::discovery
