#ifndef eunoe_discovery_study_folder_h
#define eunoe_discovery_study_folder_h

#include <eunoe/core/run_lock.h>
#include <eunoe/discovery/study.h>

#include <memory>
#include <mpi.h>

namespace eunoe::discovery {

/// The folder of a study's results.
class StudyFolder
{
public:
  StudyFolder(const std::string &path, MPI_Comm comm) : path(path), comm(comm) {}

  /// Creates the folder, or makes sure that it holds the same study. Throws a UserError on every
  /// rank, which says what differs; collective.
  /// @param identity all that decides the study: names, and for each a text whose hash is kept
  /// @param first_row number of the last row that the table of runs has now
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

/// A list of objects as a table with commas; members other than numbers, words and truth values
/// are left out. Empty for any other value.
std::string as_csv(const nlohmann::ordered_json &list);

} // namespace eunoe::discovery

#endif
