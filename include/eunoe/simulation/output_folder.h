#ifndef eunoe_simulation_output_folder_h
#define eunoe_simulation_output_folder_h

#include <eunoe/core/csv_file.h>
#include <eunoe/core/run_lock.h>
#include <eunoe/simulation/output.h>

#include <nlohmann/json_fwd.hpp>

#include <map>
#include <memory>
#include <set>

namespace eunoe {

/// The folder of the results and what grows in it, so that a run which continues another one finds
/// its tables and series of pictures as they were at the checkpoint. Nothing is written before it
/// is opened, so that a run inside another program leaves no trace.
class OutputFolder
{
public:
  OutputFolder(const std::string &path, MPI_Comm comm) : path(path), comm(comm) {}

  const std::string path;

  /// Creates the folder and keeps other runs out of it. Throws a UserError on every rank if that
  /// fails; collective.
  /// @return why others are not kept out, on the first rank; empty if they are
  std::string open();
  bool is_open() const { return opened; }

  std::string file(const std::string &name) const { return path + "/" + name; }

  /// Writes the file "name" at once, the first rank's text. Throws a UserError on every rank;
  /// collective.
  void write(const std::string &name, const std::string &text) const;

  /// The same for a file of which each rank has a part, in their order.
  void write_in_parts(const std::string &name, const std::string &mine) const;

  /// Removes files of an earlier run, but for those that this one has written or goes on with;
  /// collective.
  void remove_old(const std::vector<std::string> &names) const;

  /// A table "name", new or continued. Throws a UserError on every rank; collective.
  std::shared_ptr<CsvFile> table(const std::string &name, const std::vector<std::string> &columns);

  /// A series of pictures, likewise.
  std::shared_ptr<PictureSeries> pictures(const std::string &name);

  /// Waits until all tables and pictures would survive a crash of the machine, as a checkpoint
  /// relies on them. Throws a UserError on every rank; collective.
  void sync();

  /// How far tables and series have come.
  nlohmann::ordered_json save() const;
  /// Takes what `save` gave; tables and series that are opened from now on are continued.
  void resume(const nlohmann::ordered_json &saved);

private:
  MPI_Comm comm;
  bool opened = false;
  mutable std::set<std::string> written; ///< by `write`
  std::unique_ptr<RunLock> lock;
  std::map<std::string, std::shared_ptr<CsvFile>> tables;
  std::map<std::string, std::shared_ptr<PictureSeries>> series;
  std::map<std::string, std::uint64_t> sizes_before;
  std::map<std::string, PictureSeries::Files> files_before;
};

} // namespace eunoe

#endif
