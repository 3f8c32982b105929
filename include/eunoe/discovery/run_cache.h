#ifndef eunoe_discovery_run_cache_h
#define eunoe_discovery_run_cache_h

#include <eunoe/simulation/process.h>

#include <nlohmann/json.hpp>

#include <map>
#include <mpi.h>
#include <set>

namespace eunoe::discovery {

/// The result of a simulation.
struct RunRecord
{
  std::vector<Measurement> measurements;
  std::string failure; ///< reason of a failure; empty without one
  double core_seconds = 0.;
};

nlohmann::ordered_json to_json(const RunRecord &record);
/// Throws a nlohmann::json::exception if that is no record.
RunRecord record_from(const nlohmann::ordered_json &json);

/// A folder of finished simulations, one file each. The key of a simulation is a hash of all that
/// decides its result. Several studies may share the folder, also at the same time.
class RunCache
{
public:
  RunCache(const std::string &folder, MPI_Comm comm) : folder(folder), comm(comm) {}

  /// Creates the folder. Throws a UserError on every rank if that fails; collective.
  void open();

  /// The simulations among these keys that the folder has, the same on every rank; collective. A
  /// file that cannot be read counts as missing.
  std::map<std::string, RunRecord> load(const std::set<std::string> &keys) const;

  /// Writes a file for a simulation, complete or not at all. To be called by one rank; throws a
  /// UserError there.
  /// @param about description of the run, for people
  void store(const std::string &key, const RunRecord &record,
             const nlohmann::ordered_json &about) const;

private:
  std::string file(const std::string &key) const;

  std::string folder;
  MPI_Comm comm;
};

} // namespace eunoe::discovery

#endif
