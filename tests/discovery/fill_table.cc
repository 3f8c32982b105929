// Fills a study's table of runs with simulations that record-runs has recorded, so that the study
// starts from them.
//   fill-table study.prm recorded.txt
// Recorded values have five digits. One run of the base model and of each effect and nuisance is
// made again first; where it gives other digits, none of that effect is taken over.

#include <eunoe/core/problems.h>
#include <eunoe/core/stop_request.h>
#include <eunoe/discovery/dem_simulator.h>
#include <eunoe/discovery/study_input.h>

#include <deal.II/base/mpi.h>

#include "recorded_table.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <set>

namespace {

using namespace eunoe;
using namespace eunoe::discovery;

RunRequest request_of(const test::RecordedTable::Run &run)
{
  if (run.factor == "base")
    return {run.experiment, {}, run.seed};
  return {run.experiment, {{run.factor, run.amplitude}}, run.seed};
}

std::string digits(const double value)
{
  char text[32];
  std::snprintf(text, sizeof text, "%.5g", value);
  return text;
}

/// Factors whose runs this engine repeats, digit by digit, as far as one run of each shows.
std::set<std::string> repeatable(DemSimulator &simulator, const test::RecordedTable &table,
                                 const std::vector<test::RecordedTable::Run> &runs)
{
  std::map<std::string, test::RecordedTable::Run> samples; // the last of each
  for (const auto &run : runs)
    samples[run.factor] = run;
  std::vector<RunRequest> requests;
  for (const auto &[factor, run] : samples)
    requests.push_back(request_of(run));
  const std::vector<RunResult> results = simulator.run(requests);
  std::set<std::string> same;
  std::size_t k = 0;
  for (const auto &[factor, run] : samples) {
    const auto &given = simulator.data_points(run.experiment);
    const auto &recorded = table.points.at(run.experiment);
    const RunResult &result = results[k++];
    bool is_same = result.has_value();
    for (std::size_t c = 0; c < recorded.size() && is_same; ++c) {
      const auto place = std::find(given.begin(), given.end(), recorded[c]);
      is_same = place != given.end() &&
                digits((*result)[static_cast<std::size_t>(place - given.begin())]) ==
                    digits(run.values(static_cast<Eigen::Index>(c)));
    }
    if (is_same)
      same.insert(factor);
  }
  return same;
}

void fill(const std::string &study_file, const std::string &recorded)
{
  Problems problems;
  const StudyInput study = read_study(study_file, {}, false, MPI_COMM_WORLD, problems);
  if (!problems.empty())
    throw UserError(problems);
  const test::RecordedTable table(recorded, false);
  std::vector<test::RecordedTable::Run> runs;
  for (const auto &run : table.runs)
    if (std::any_of(study.experiments.begin(), study.experiments.end(),
                    [&](const Experiment &e) { return e.name() == run.experiment; }))
      runs.push_back(run);
  if (runs.empty())
    throw UserError("No recorded run is of an experiment of the study.");
  Log log(MPI_COMM_WORLD, false);
  DemSimulator simulator(study.experiments, study.factors, study.parameters.table_file(), 1,
                         MPI_COMM_WORLD, log);
  simulator.find_data_points(1);
  const std::set<std::string> same = repeatable(simulator, table, runs);
  std::size_t n_taken = 0;
  for (const auto &run : runs) {
    if (same.count(run.factor) == 0)
      continue;
    ++n_taken;
    RunRecord record;
    const auto &points = table.points.at(run.experiment);
    for (std::size_t c = 0; c < points.size(); ++c)
      record.measurements.push_back(
          {points[c].observable, points[c].index, run.values(static_cast<Eigen::Index>(c))});
    simulator.take_over(request_of(run), record);
  }
  log.line(std::to_string(n_taken) + " of " + std::to_string(runs.size()) +
           " recorded runs are in " + study.parameters.table_file() +
           " now; this engine repeats those of " + std::to_string(same.size()) + " factors.");
}

} // namespace

int main(int argc, char **argv)
{
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  try {
    if (argc != 3)
      throw UserError("Usage: fill-table study.prm recorded.txt");
    stop_request::listen();
    fill(argv[1], argv[2]);
  } catch (const UserError &error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  } catch (const Interrupted &) {
    return 3;
  }
  return 0;
}
