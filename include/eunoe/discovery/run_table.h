#ifndef eunoe_discovery_run_table_h
#define eunoe_discovery_run_table_h

#include <eunoe/discovery/simulator.h>
#include <eunoe/simulation/process.h>

#include <nlohmann/json.hpp>

#include <map>
#include <memory>
#include <mpi.h>
#include <string>
#include <vector>

namespace eunoe::discovery {

/// The result of a simulation.
struct RunRecord
{
  std::vector<Measurement> measurements;
  std::string failure; ///< reason of a failure; empty without one
  double core_seconds = 0.;
};

/// The table of runs: all finished simulations of a study in one SQLite file, which further studies
/// use as well, also at the same time. A row has the design point, the result, a key that is a hash
/// of the case, and the digest of the engine that made it. As it takes a while to make a case, the
/// file also has the keys of recipes, which are hashes of an engine and what it makes a case from,
/// and what all entries of a base case were by an engine.
class RunTable
{
public:
  struct Row
  {
    std::int64_t number = 0; ///< rows are numbered in the order in which they were finished
    std::string key, engine;
    RunRequest request;
    RunRecord record;
  };

  RunTable(const std::string &file, MPI_Comm comm) : file(file), comm(comm) {}

  /// Creates the file. Throws a UserError on every rank if that fails; collective.
  void open();

  /// All rows in their order, the same on every rank; collective.
  std::vector<Row> rows() const;

  /// Adds a row. To be called by one rank; throws a UserError there.
  void store(const Row &row) const;

  /// Keys by recipe, the same on every rank; collective.
  std::map<std::string, std::string> keys() const;

  /// Adds keys by recipe; collective.
  void store_keys(const std::map<std::string, std::string> &keys) const;

  /// Gives rows to an engine that was found to give the same results, with the keys that they have
  /// here; one that has such a row keeps its own. Collective.
  void adopt(const std::vector<const Row *> &rows, const std::string &engine) const;

private:
  const std::string file;
  MPI_Comm comm;
};

/// The measured values as text, equal for equal bits.
std::string text_of(const std::vector<Measurement> &measurements);

nlohmann::ordered_json to_json(const RunRecord &record);
/// Throws a nlohmann::json::exception if that is no record.
RunRecord record_from(const nlohmann::ordered_json &json);

} // namespace eunoe::discovery

#endif
