#include <eunoe/discovery/stages/stages.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace eunoe::discovery {

namespace {

/// Runs of the base model and of each member of a tie, all with the same columns.
struct Rows
{
  std::vector<Cell> cells;
  Eigen::MatrixXd base;               ///< runs x cells, for the chaos
  std::vector<Eigen::VectorXd> means; ///< of each member of the tie
  std::vector<double> leverages;
};

/// How far an observable would set each member of the tie apart from the likeliest, in standard
/// deviations of one measurement; the least of them, as a tie is broken when all are out.
double separation(const Rows &rows, const std::vector<Eigen::Index> &columns)
{
  std::vector<Cell> cells;
  Eigen::MatrixXd base(rows.base.rows(), static_cast<Eigen::Index>(columns.size()));
  std::vector<double> deviations;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    base.col(static_cast<Eigen::Index>(c)) = rows.base.col(columns[c]);
    cells.push_back(rows.cells[static_cast<std::size_t>(columns[c])]);
  }
  if (!base.allFinite())
    return 0.;
  const Eigen::VectorXd deviation = (centred(base).colwise().squaredNorm().transpose() /
                                     static_cast<double>(base.rows() - 1))
                                        .cwiseSqrt();
  const double floor = 0.2 * deviation.maxCoeff();
  if (floor <= 0.)
    return 0.;
  const Modes modes(cells, deviation.cwiseMax(floor));
  Eigen::MatrixXd reduced(base.rows(), modes.n_modes());
  for (Eigen::Index r = 0; r < base.rows(); ++r)
    reduced.row(r) = modes.reduce(base.row(r).transpose()).transpose();
  Covariance chaos = shrunk_covariance(centred(reduced), static_cast<double>(base.rows() - 1),
                                       modes.experiment_of_mode());
  chaos.matrix.diagonal().array() += 1e-3;
  const Eigen::LDLT<Eigen::MatrixXd> factor(chaos.matrix);
  double least = 1e300;
  for (std::size_t m = 1; m < rows.means.size(); ++m) {
    Eigen::VectorXd change(static_cast<Eigen::Index>(columns.size()));
    for (std::size_t c = 0; c < columns.size(); ++c)
      change(static_cast<Eigen::Index>(c)) =
          rows.means[m](columns[c]) - rows.means[0](columns[c]);
    if (!change.allFinite())
      return 0.;
    const Eigen::VectorXd z = modes.reduce(change);
    const double noise =
        (rows.leverages[m] + rows.leverages[0]) * static_cast<double>(modes.n_modes());
    least = std::min(least, std::sqrt(std::max(0., z.dot(factor.solve(z)) - noise)));
  }
  return least;
}

/// One row for each observable of which some cells are not measured yet.
void add_observables(const Rows &rows, const std::vector<Cell> &known, Table &table)
{
  std::map<std::pair<std::string, std::string>, std::vector<Eigen::Index>> groups;
  for (std::size_t c = 0; c < rows.cells.size(); ++c)
    if (std::find(known.begin(), known.end(), rows.cells[c]) == known.end())
      groups[{rows.cells[c].experiment, rows.cells[c].observable}].push_back(
          static_cast<Eigen::Index>(c));
  for (const auto &[name, columns] : groups) {
    Table indices = Table::array();
    for (const Eigen::Index c : columns)
      indices.push_back(rows.cells[static_cast<std::size_t>(c)].index);
    table.push_back({{"experiment", name.first},
                     {"observable", name.second},
                     {"indices", indices},
                     {"separation", separation(rows, columns)}});
  }
}

Rows rows_of_study(const Workbench &bench, const std::vector<Scored> &tie)
{
  Rows rows;
  rows.cells = bench.columns;
  rows.base.resize(static_cast<Eigen::Index>(bench.base().size()),
                   static_cast<Eigen::Index>(bench.columns.size()));
  for (std::size_t r = 0; r < bench.base().size(); ++r)
    rows.base.row(static_cast<Eigen::Index>(r)) = bench.base()[r].values.transpose();
  for (const Scored &member : tie) {
    const Response response = bench.response_of_columns(member.fit.effects);
    rows.means.push_back(response.origin() + response.change(member.fit.position));
    rows.leverages.push_back(response.leverage(member.fit.position));
  }
  return rows;
}

/// Makes a few runs of an experiment that is not in the data; without rows if the budget does not
/// allow them or runs fail.
Rows rows_of_experiment(Workbench &bench, const std::vector<Scored> &tie,
                        const std::string &experiment)
{
  constexpr std::uint32_t base_runs = 8, member_runs = 4;
  std::vector<RunRequest> requests;
  const std::uint32_t seed = 100000u * bench.options.seed + 1u;
  for (std::uint32_t k = 0; k < base_runs; ++k)
    requests.push_back({experiment, {}, seed + k});
  for (const Scored &member : tie)
    for (std::uint32_t k = 0; k < member_runs; ++k)
      requests.push_back({experiment,
                          bench.amplitudes(member.fit.effects, member.fit.position), seed + k});
  Rows rows;
  if (requests.size() > bench.archive.remaining())
    return rows;
  const std::vector<RunResult> results = bench.archive.get(requests);
  rows.cells = bench.archive.laboratory().cells(experiment);
  const auto n = static_cast<Eigen::Index>(rows.cells.size());
  std::size_t place = 0;
  const auto take = [&](std::uint32_t number) {
    std::vector<Eigen::VectorXd> good;
    for (std::uint32_t k = 0; k < number; ++k, ++place)
      if (results[place])
        good.push_back(Eigen::Map<const Eigen::VectorXd>(results[place]->data(), n));
    return good;
  };
  const auto base = take(base_runs);
  if (base.size() < 4)
    return {};
  rows.base.resize(static_cast<Eigen::Index>(base.size()), n);
  for (std::size_t r = 0; r < base.size(); ++r)
    rows.base.row(static_cast<Eigen::Index>(r)) = base[r].transpose();
  for (std::size_t m = 0; m < tie.size(); ++m) {
    const auto good = take(member_runs);
    if (good.empty())
      return {};
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(n);
    for (const Eigen::VectorXd &values : good)
      mean += values / static_cast<double>(good.size());
    rows.means.push_back(mean);
    rows.leverages.push_back(1. / static_cast<double>(good.size()));
  }
  return rows;
}

/// How often the same measurement would have to be repeated to tell the members apart.
Table more_repeats(const Workbench &bench, const std::vector<Scored> &tie)
{
  constexpr double clear = 4.; // standard deviations
  double least = 1e300;
  for (std::size_t m = 1; m < tie.size(); ++m) {
    const Fit &a = tie[0].fit, &b = tie[m].fit;
    const double noise = (a.leverage + b.leverage) * static_cast<double>(bench.misfit.size());
    const Eigen::VectorXd change = a.remainder - b.remainder;
    least = std::min(least, std::sqrt(std::max(0., change.squaredNorm() - noise)));
  }
  return {{"experiment", "the same"},
          {"observable", "the same"},
          {"separation", least},
          {"repeats", least > 0. ? Table(std::ceil(std::pow(clear / least, 2))) : Table(nullptr)}};
}

} // namespace

Table separating_measurements(Workbench &bench, const std::vector<Scored> &tie)
{
  constexpr std::size_t most = 4;
  const std::vector<Scored> members(tie.begin(), tie.begin() + std::min(most, tie.size()));
  std::vector<Cell> known = bench.cells;
  for (const MeasuredCell &cell : bench.data.fit)
    known.push_back(cell.cell);
  Table rows = Table::array();
  add_observables(rows_of_study(bench, members), known, rows);
  for (const std::string &experiment : bench.options.further_experiments) {
    if (std::find(bench.experiments.begin(), bench.experiments.end(), experiment) !=
        bench.experiments.end())
      continue;
    const Rows further = rows_of_experiment(bench, members, experiment);
    if (further.means.size() == members.size())
      add_observables(further, known, rows);
  }
  std::stable_sort(rows.begin(), rows.end(), [](const Table &a, const Table &b) {
    return a["separation"].get<double>() > b["separation"].get<double>();
  });
  rows.push_back(more_repeats(bench, members));
  return rows;
}

} // namespace eunoe::discovery
