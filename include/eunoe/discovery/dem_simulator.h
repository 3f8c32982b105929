#ifndef eunoe_discovery_dem_simulator_h
#define eunoe_discovery_dem_simulator_h

#include <eunoe/core/log.h>
#include <eunoe/discovery/experiment.h>
#include <eunoe/discovery/run_table.h>
#include <eunoe/discovery/work_queue.h>

#include <nlohmann/json.hpp>

#include <limits>
#include <set>

namespace eunoe::discovery {

/// Runs DEM simulations on groups of ranks, each simulation once, and keeps their results in a
/// table. What another version of the program has left there is adopted if samples of it, run
/// again, give the same bits.
class DemSimulator : public Simulator
{
public:
  /// @param factors effects and nuisances that requests may name
  /// @param table_file created if missing
  DemSimulator(const std::vector<Experiment> &experiments, const std::vector<Effect> &factors,
               const std::string &table_file, unsigned int ranks_per_run, MPI_Comm comm, Log &log);

  /// Runs every experiment, the base model or with these amplitudes, to see which data points it
  /// gives: those of all these runs, with seeds from `seed` on, but for runs that break off. Throws
  /// a UserError if all do; collective. To be called before `data_points`.
  void find_data_points(std::uint32_t seed, const Amplitudes &amplitudes = {},
                        unsigned int runs = 1);
  /// Data points that only some of these runs gave, such as a bin without powder in others.
  const std::set<DataPoint> &rare_points() const { return rare; }

  /// Adds a simulation to the table that this engine has made elsewhere; collective.
  void take_over(const RunRequest &request, const RunRecord &record);

  /// From now on a run without a value for one of these data points counts as failed. For any other
  /// data point that the base model gives, such a run has NaN.
  void require(const std::vector<DataPoint> &points) { required = {points.begin(), points.end()}; }

  /// Number of the last row of the table when this simulator was made. Rows after `last` are not
  /// offered by `known`, so that a study that goes on takes the same decisions again.
  std::int64_t last_row() const { return earlier.empty() ? 0 : earlier.back().number; }
  void hide_rows_after(std::int64_t last) { last_known = last; }

  const std::vector<DataPoint> &data_points(const std::string &experiment) const override;
  std::vector<RunResult> run(const std::vector<RunRequest> &requests) override;
  bool concerns(const std::string &experiment,
                const std::vector<std::string> &effects) const override;
  std::vector<std::pair<RunRequest, RunResult>> known(const std::string &experiment) override;

  /// Number of simulations that were run so far, and of requests that earlier ones answered.
  std::uint64_t n_runs() const { return made; }
  std::uint64_t n_cached() const { return cached; }

  /// All runs that were asked for, in the order of first asking: experiment, amplitudes, seed, key
  /// in the table, what it cost, and why it failed, if it did.
  const nlohmann::ordered_json &ledger() const { return runs; }

private:
  const Experiment &find(const std::string &experiment) const;
  /// Whether the study has the experiment and all factors of a request.
  bool is_of_study(const RunRequest &request) const;
  /// Collective.
  StudyCase case_of(const RunRequest &request) const
  {
    return find(request.experiment).make_case(factors, request, comm);
  }
  /// The key of the case of a row; empty if the row was made of another case. The case is made
  /// only if no recipe tells its key; collective.
  std::string key_of(const RunTable::Row &row);
  /// Notes the key of a case by its recipe.
  void remember(const StudyCase &one);
  void store_new_keys();
  RunRecord simulate(const StudyCase &one);
  void serve_and_check_stop(unsigned long long step);
  /// Runs those cases of which there is no result, each once.
  /// @return their keys
  std::set<std::string> simulate_missing(const std::vector<StudyCase> &cases);
  void adopt_earlier_runs();
  void adopt(const std::vector<const RunTable::Row *> &rows);
  std::set<std::string> find_changes(const std::map<std::string, const RunTable::Row *> &samples);
  /// Why a run has no result; empty if it has one.
  std::string failure_of(const RunRequest &request, const RunRecord &record) const;
  RunResult result(const RunRequest &request, const RunRecord &record) const;
  /// Notes a request that has an answer now.
  void add_to_ledger(const RunRequest &request, const std::string &key, bool was_cached);

  const std::vector<Experiment> &experiments;
  const std::vector<Effect> &factors;
  RunTable table;
  /// Rows that were there at the start; once they have been looked through, with today's keys, or
  /// none if they are of other cases.
  std::vector<RunTable::Row> earlier;
  std::int64_t last_known = std::numeric_limits<std::int64_t>::max();
  WorkQueue queue;
  MPI_Comm comm;
  Log &log;
  std::map<std::string, std::vector<DataPoint>> known_points;
  std::set<DataPoint> rare, required;
  std::map<std::string, RunRecord> records;                    ///< by key
  std::map<std::string, std::string> keys;                     ///< by what was requested
  std::map<std::string, std::string> keys_by_recipe, new_keys; ///< the new ones not in the table
  std::uint64_t made = 0, cached = 0;
  nlohmann::ordered_json runs = nlohmann::ordered_json::array();
};

} // namespace eunoe::discovery

#endif
