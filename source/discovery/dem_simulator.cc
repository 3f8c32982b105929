#include <eunoe/core/first_rank.h>
#include <eunoe/core/problems.h>
#include <eunoe/core/stop_request.h>
#include <eunoe/core/version.h>
#include <eunoe/discovery/dem_simulator.h>
#include <eunoe/simulation/simulation.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <sstream>
#include <utility>

namespace eunoe::discovery {

namespace {

/// What a run has measured at a data point; NaN if nothing.
double value_at(const DataPoint &point, const RunRecord &record)
{
  for (const Measurement &m : record.measurements)
    if (m.observable == point.observable && m.index == point.index)
      return m.value;
  return std::nan("");
}

} // namespace

DemSimulator::DemSimulator(const std::vector<Experiment> &experiments,
                           const std::vector<Effect> &factors, const std::string &table_file,
                           const unsigned int ranks_per_run, MPI_Comm comm, Log &log)
    : experiments(experiments), factors(factors), table(table_file, comm),
      queue(comm, ranks_per_run), comm(comm), log(log)
{
  table.open();
  earlier = table.rows();
  keys_by_recipe = table.keys();
  for (const RunTable::Row &row : earlier)
    if (row.engine == engine_digest())
      records[row.key] = row.record;
}

const Experiment &DemSimulator::find(const std::string &experiment) const
{
  return *std::find_if(experiments.begin(), experiments.end(),
                       [&](const Experiment &e) { return e.name() == experiment; });
}

bool DemSimulator::concerns(const std::string &experiment,
                            const std::vector<std::string> &effects) const
{
  const std::string &process = find(experiment).process_name();
  return effects.empty() || std::any_of(factors.begin(), factors.end(), [&](const Effect &e) {
           return e.concerns(process) &&
                  std::find(effects.begin(), effects.end(), e.name) != effects.end();
         });
}

std::vector<std::pair<RunRequest, RunResult>> DemSimulator::known(const std::string &experiment)
{
  std::vector<std::pair<RunRequest, RunResult>> result;
  std::set<std::string> given; // a row of each engine may have it
  for (const RunTable::Row &row : earlier) {
    if (row.request.experiment != experiment || row.number > last_known ||
        records.count(row.key) == 0)
      continue;
    const std::string text = text_of(row.request);
    if (keys.count(text) == 0)
      add_to_ledger(row.request, row.key, true);
    if (keys.at(text) == row.key && given.insert(text).second)
      result.emplace_back(row.request, this->result(row.request, records.at(row.key)));
  }
  return result;
}

void DemSimulator::take_over(const RunRequest &request, const RunRecord &record)
{
  const StudyCase one = case_of(request);
  if (!one.problem.empty())
    throw UserError(one.problem);
  on_first_rank(comm, [&] { table.store({0, one.key, engine_digest(), request, record}); });
  records.emplace(one.key, record);
}

void DemSimulator::find_data_points(const std::uint32_t seed, const Amplitudes &amplitudes,
                                    const unsigned int runs)
{
  adopt_earlier_runs();
  std::vector<RunRequest> requests;
  for (const Experiment &experiment : experiments)
    for (unsigned int r = 0; r < runs; ++r)
      requests.push_back({experiment.name(), amplitudes, seed + r});
  run(requests);
  std::map<DataPoint, unsigned int> given;
  std::map<std::string, unsigned int> succeeded;
  for (const RunRequest &request : requests) {
    const RunRecord &record = records.at(keys.at(text_of(request)));
    succeeded[request.experiment] += record.failure.empty();
    if (!record.failure.empty() && request.seed == seed + runs - 1 &&
        succeeded[request.experiment] == 0)
      throw UserError((amplitudes.empty() ? "The base model" : "The truth") + std::string(" of ") +
                      "experiment '" + request.experiment + "' cannot be run: " + record.failure);
    std::vector<DataPoint> &points = known_points[request.experiment];
    for (const Measurement &m : record.measurements) {
      const DataPoint point{request.experiment, m.observable, m.index};
      if (std::isfinite(m.value) && ++given[point] == 1)
        points.push_back(point);
    }
  }
  for (auto &[experiment, points] : known_points) {
    const unsigned int all = succeeded[experiment];
    const auto first_rare = std::stable_partition(
        points.begin(), points.end(), [&](const DataPoint &point) { return given[point] == all; });
    rare.insert(first_rare, points.end());
    points.erase(first_rare, points.end());
  }
}

const std::vector<DataPoint> &DemSimulator::data_points(const std::string &experiment) const
{
  return known_points.at(experiment);
}

void DemSimulator::serve_and_check_stop(const unsigned long long step)
{
  constexpr unsigned int steps_between_looks = 16, steps_between_votes = 256;
  if (step % steps_between_looks == 0)
    queue.serve();
  int stops = stop_request::received() != 0 ? 1 : 0;
  if (!queue.is_alone()) {
    if (step % steps_between_votes != 0)
      return;
    MPI_Allreduce(MPI_IN_PLACE, &stops, 1, MPI_INT, MPI_MAX, queue.group());
  }
  if (stops != 0)
    throw Interrupted();
}

RunRecord DemSimulator::simulate(const StudyCase &one)
{
  RunRecord record;
  record.failure = one.problem;
  if (!record.failure.empty())
    return record;
  int size;
  MPI_Comm_size(queue.group(), &size);
  const double begin = MPI_Wtime();
  Log silent(queue.group(), true);
  try {
    Problems problems;
    Parameters parameters = one.experiment->make(one.overrides, problems);
    Simulation simulation(parameters, queue.group(), silent);
    const Forecast forecast = simulation.foresee(false);
    if (!forecast.problems.empty())
      throw UserError(forecast.problems);
    simulation.run([this](Simulation &s) { serve_and_check_stop(s.step_number()); });
    record.measurements = simulation.measurements();
    if (record.measurements.empty())
      record.failure = "The run ended before anything was measured. Check 'time end'.";
  } catch (const UserError &error) {
    record.failure = error.what();
  } catch (const std::bad_alloc &) {
    throw; // not a failure of the model
  } catch (const std::exception &error) {
    // The other ranks of the group may not have this exception.
    if (!queue.is_alone())
      throw;
    record.failure = error.what();
  }
  record.core_seconds = (MPI_Wtime() - begin) * size;
  return record;
}

std::set<std::string> DemSimulator::simulate_missing(const std::vector<StudyCase> &cases)
{
  const double begin = MPI_Wtime();
  std::set<std::string> begun;
  std::vector<const StudyCase *> missing;
  for (const StudyCase &one : cases)
    if (records.count(one.key) == 0 && begun.insert(one.key).second)
      missing.push_back(&one);
  if (missing.empty())
    return begun;
  const int n = static_cast<int>(missing.size());
  auto mine = nlohmann::ordered_json::array();
  std::string error;
  bool interrupted = false;
  const auto one_case = [&](const int k) {
    const StudyCase &one = *missing[k];
    const RunRecord record = simulate(one);
    if (queue.is_leader()) {
      mine.push_back({one.key, to_json(record)});
      try {
        table.store({0, one.key, engine_digest(), one.request, record});
      } catch (const UserError &failure) {
        error = failure.what();
      }
    }
    int failed = error.empty() ? 0 : 1;
    MPI_Bcast(&failed, 1, MPI_INT, 0, queue.group());
    if (failed != 0)
      throw Interrupted();
  };
  try {
    queue.run(n, one_case, [&](const int done) {
      const double left = (MPI_Wtime() - begin) * (n - done) / std::max(1, done);
      log.status(std::to_string(done) + " of " + std::to_string(n) +
                 " runs, left: " + format_duration(left));
    });
  } catch (const Interrupted &) {
    interrupted = true;
  }
  const std::string errors = concatenate(error, comm);
  if (!errors.empty())
    throw UserError(errors);
  if (interrupted)
    throw Interrupted();
  std::istringstream lines(concatenate(mine.dump() + "\n", comm));
  for (std::string line; std::getline(lines, line);)
    for (const auto &item : nlohmann::ordered_json::parse(line)) {
      records[item.at(0)] = record_from(item.at(1));
      ++made;
    }
  return begun;
}

std::string DemSimulator::failure_of(const RunRequest &request, const RunRecord &record) const
{
  if (!record.failure.empty())
    return record.failure;
  for (const DataPoint &point : required)
    if (point.experiment == request.experiment && !std::isfinite(value_at(point, record)))
      return "The run ended without a value of '" + point.observable + "', index " +
             std::to_string(point.index) + ", which was measured.";
  return "";
}

RunResult DemSimulator::result(const RunRequest &request, const RunRecord &record) const
{
  if (!failure_of(request, record).empty())
    return std::nullopt;
  std::vector<double> values;
  if (const auto known = known_points.find(request.experiment); known != known_points.end())
    for (const DataPoint &point : known->second)
      values.push_back(value_at(point, record));
  return values;
}

void DemSimulator::add_to_ledger(const RunRequest &request, const std::string &key,
                                 const bool was_cached)
{
  const RunRecord &record = records.at(key);
  keys[text_of(request)] = key;
  cached += was_cached ? 1 : 0;
  nlohmann::ordered_json run = {{"experiment", request.experiment},
                                {"amplitudes", request.amplitudes},
                                {"seed", request.seed},
                                {"key", key},
                                {"cached", was_cached},
                                {"core_seconds", record.core_seconds}};
  if (const std::string failure = failure_of(request, record); !failure.empty())
    run["failure"] = failure;
  runs.push_back(run);
}

std::vector<RunResult> DemSimulator::run(const std::vector<RunRequest> &requests)
{
  std::vector<StudyCase> unknown;
  std::set<std::string> texts;
  for (const RunRequest &request : requests)
    if (keys.count(text_of(request)) == 0 && texts.insert(text_of(request)).second)
      unknown.push_back(case_of(request));
  for (const StudyCase &one : unknown)
    remember(one);
  store_new_keys();
  const std::set<std::string> begun = simulate_missing(unknown);
  for (const StudyCase &one : unknown)
    add_to_ledger(one.request, one.key, begun.count(one.key) == 0);
  std::vector<RunResult> results;
  for (const RunRequest &request : requests)
    results.push_back(result(request, records.at(keys.at(text_of(request)))));
  return results;
}

} // namespace eunoe::discovery
