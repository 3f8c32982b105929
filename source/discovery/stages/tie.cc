#include <eunoe/discovery/stages/stages.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace eunoe::discovery {

namespace {

/// Replicates of the base model, and predictions of each member of a tie, at the same data points.
struct Rows
{
  std::vector<DataPoint> points;
  Eigen::MatrixXd base;               ///< replicates x data points, for the covariance
  std::vector<Eigen::VectorXd> means; ///< of each member of the tie
  std::vector<double> leverages;
};

/// Distance of each member of the tie from the likeliest one, as one measurement of an observable
/// would show it, in standard deviations. The smallest of them counts, because a tie is broken only
/// when all other members are refuted.
double separation(const Rows &rows, const std::vector<Eigen::Index> &columns)
{
  std::vector<DataPoint> points;
  Eigen::MatrixXd base(rows.base.rows(), static_cast<Eigen::Index>(columns.size()));
  std::vector<double> deviations;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    base.col(static_cast<Eigen::Index>(c)) = rows.base.col(columns[c]);
    points.push_back(rows.points[static_cast<std::size_t>(columns[c])]);
  }
  if (!base.allFinite())
    return 0.;
  const Eigen::VectorXd deviation =
      (centred(base).colwise().squaredNorm().transpose() / static_cast<double>(base.rows() - 1))
          .cwiseSqrt();
  const double floor = 0.2 * deviation.maxCoeff();
  if (floor <= 0.)
    return 0.;
  const Modes modes(points, deviation.cwiseMax(floor));
  Eigen::MatrixXd reduced(base.rows(), modes.n_modes());
  for (Eigen::Index r = 0; r < base.rows(); ++r)
    reduced.row(r) = modes.reduce(base.row(r).transpose()).transpose();
  Covariance covariance = shrunk_covariance(centred(reduced), static_cast<double>(base.rows() - 1),
                                            modes.experiment_of_mode());
  covariance.matrix.diagonal().array() += 1e-3;
  const Eigen::LDLT<Eigen::MatrixXd> factor(covariance.matrix);
  double least = 1e300;
  for (std::size_t m = 1; m < rows.means.size(); ++m) {
    Eigen::VectorXd change(static_cast<Eigen::Index>(columns.size()));
    for (std::size_t c = 0; c < columns.size(); ++c)
      change(static_cast<Eigen::Index>(c)) = rows.means[m](columns[c]) - rows.means[0](columns[c]);
    if (!change.allFinite())
      return 0.;
    const Eigen::VectorXd z = modes.reduce(change);
    const double noise =
        (rows.leverages[m] + rows.leverages[0]) * static_cast<double>(modes.n_modes());
    least = std::min(least, std::sqrt(std::max(0., z.dot(factor.solve(z)) - noise)));
  }
  return least;
}

/// One row for each observable of which some data points are not measured yet.
void add_observables(const Rows &rows, const std::vector<DataPoint> &known, Table &table)
{
  std::map<std::pair<std::string, std::string>, std::vector<Eigen::Index>> groups;
  for (std::size_t c = 0; c < rows.points.size(); ++c)
    if (std::find(known.begin(), known.end(), rows.points[c]) == known.end())
      groups[{rows.points[c].experiment, rows.points[c].observable}].push_back(
          static_cast<Eigen::Index>(c));
  for (const auto &[name, columns] : groups) {
    Table indices = Table::array();
    for (const Eigen::Index c : columns)
      indices.push_back(rows.points[static_cast<std::size_t>(c)].index);
    table.push_back({{"experiment", name.first},
                     {"observable", name.second},
                     {"indices", indices},
                     {"separation", separation(rows, columns)}});
  }
}

Rows rows_of_study(const StudyState &study, const std::vector<ScoredModel> &tie)
{
  Rows rows;
  rows.points = study.columns;
  rows.base.resize(static_cast<Eigen::Index>(study.base().size()),
                   static_cast<Eigen::Index>(study.columns.size()));
  for (std::size_t r = 0; r < study.base().size(); ++r)
    rows.base.row(static_cast<Eigen::Index>(r)) = study.base()[r].values.transpose();
  for (const ScoredModel &member : tie) {
    const Emulator emulator = study.emulator_of_columns(member.fit.effects);
    rows.means.push_back(emulator.origin() + emulator.change(member.fit.position));
    rows.leverages.push_back(emulator.leverage(member.fit.position));
  }
  return rows;
}

/// Makes a few runs of an experiment that is not in the data; without rows if the budget does not
/// allow them or runs fail.
Rows rows_of_experiment(StudyState &study, const std::vector<ScoredModel> &tie,
                        const std::string &experiment)
{
  constexpr std::uint32_t base_runs = 8, member_runs = 4;
  std::vector<RunRequest> requests;
  const std::uint32_t seed = 100000u * study.options.seed + 1u;
  for (std::uint32_t k = 0; k < base_runs; ++k)
    requests.push_back({experiment, {}, seed + k});
  for (const ScoredModel &member : tie)
    for (std::uint32_t k = 0; k < member_runs; ++k)
      requests.push_back(
          {experiment, study.amplitudes(member.fit.effects, member.fit.position), seed + k});
  Rows rows;
  if (requests.size() > study.archive.remaining())
    return rows;
  const std::vector<RunResult> results = study.archive.get(requests);
  rows.points = study.archive.simulator().data_points(experiment);
  const auto n = static_cast<Eigen::Index>(rows.points.size());
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
Table more_repeats(const StudyState &study, const std::vector<ScoredModel> &tie)
{
  constexpr double clear = 4.; // standard deviations
  double least = 1e300;
  for (std::size_t m = 1; m < tie.size(); ++m) {
    const Fit &a = tie[0].fit, &b = tie[m].fit;
    const double noise = (a.leverage + b.leverage) * static_cast<double>(study.misfit.size());
    const Eigen::VectorXd change = a.remainder - b.remainder;
    least = std::min(least, std::sqrt(std::max(0., change.squaredNorm() - noise)));
  }
  return {{"experiment", "the same"},
          {"observable", "the same"},
          {"separation", least},
          {"repeats", least > 0. ? Table(std::ceil(std::pow(clear / least, 2))) : Table(nullptr)}};
}

} // namespace

Table separating_measurements(StudyState &study, const std::vector<ScoredModel> &tie)
{
  constexpr std::size_t most = 4;
  const std::vector<ScoredModel> members(tie.begin(), tie.begin() + std::min(most, tie.size()));
  std::vector<DataPoint> known = study.data_points;
  for (const MeasuredPoint &point : study.data.fit)
    known.push_back(point.point);
  Table rows = Table::array();
  add_observables(rows_of_study(study, members), known, rows);
  for (const std::string &experiment : study.options.further_experiments) {
    if (std::find(study.experiments.begin(), study.experiments.end(), experiment) !=
        study.experiments.end())
      continue;
    const Rows further = rows_of_experiment(study, members, experiment);
    if (further.means.size() == members.size())
      add_observables(further, known, rows);
  }
  std::stable_sort(rows.begin(), rows.end(), [](const Table &a, const Table &b) {
    return a["separation"].get<double>() > b["separation"].get<double>();
  });
  rows.push_back(more_repeats(study, members));
  return rows;
}

} // namespace eunoe::discovery
