#ifndef eunoe_discovery_results_h
#define eunoe_discovery_results_h

#include <eunoe/core/run_lock.h>
#include <eunoe/discovery/dem_simulator.h>
#include <eunoe/discovery/study_input.h>

#include <memory>

namespace eunoe::discovery {

/// The folder of a study's results.
class StudyFolder
{
public:
  StudyFolder(const std::string &path, MPI_Comm comm) : path(path), comm(comm) {}

  /// Creates the folder, or makes sure that it holds the same study. Throws a UserError on every
  /// rank, which says what differs; collective.
  /// @param identity all that decides the study: names, and for each a text whose hash is kept
  /// @param last_row number of the last row that the table of runs has now
  /// @return number of the last row that it had when the study began; nothing if it begins now
  std::optional<std::int64_t> open(const std::map<std::string, std::string> &identity,
                                   std::int64_t last_row);

  /// Writes a list that looks like a table as a file.
  void write_csv(const std::string &name, const nlohmann::ordered_json &list) const;

  /// Writes a file on the first rank. Throws a UserError on every rank; collective.
  void write(const std::string &name, const std::string &text) const;

  /// Path of a file in the folder; one that is absolute stays.
  std::string file(const std::string &name) const;

private:
  const std::string path;
  MPI_Comm comm;
  std::unique_ptr<RunLock> lock;
};

/// Writes, for every experiment, "model_before_<experiment>.prm" and
/// "model_after_<experiment>.prm", which eunoe-particles runs as they are, and
/// "model_<experiment>.diff", the entries in which they differ. Collective.
/// @param after amplitudes of the effects that the model lacked
void write_models(const StudyInput &study, const Amplitudes &after, const StudyFolder &folder);

/// Writes discovery.json: the answer, its provenance, and all runs. Collective.
void write_answer(const StudyInput &study, const Discovery &discovery,
                  const DemSimulator &simulator, const StudyFolder &folder);

/// Makes discovery.html of a folder on the first rank, and warns if that fails.
void write_page(const std::string &folder, MPI_Comm comm, Log &log);

} // namespace eunoe::discovery

#endif
