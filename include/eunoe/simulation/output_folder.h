#ifndef eunoe_simulation_output_folder_h
#define eunoe_simulation_output_folder_h

#include <eunoe/core/csv_file.h>
#include <eunoe/simulation/output.h>

#include <nlohmann/json_fwd.hpp>

#include <map>
#include <memory>

namespace eunoe {

/// The folder of the results and what grows in it, so that a run which continues another one finds
/// its tables and series of pictures as they were at the checkpoint.
class OutputFolder
{
public:
  OutputFolder(const std::string &path, MPI_Comm comm) : path(path), comm(comm) {}

  const std::string path;

  std::string file(const std::string &name) const { return path + "/" + name; }

  /// A table "name", new or continued. Throws a UserError on every rank; collective.
  std::shared_ptr<CsvFile> table(const std::string &name, const std::vector<std::string> &columns);

  /// A series of pictures, likewise.
  std::shared_ptr<PictureSeries> pictures(const std::string &name);

  /// How far tables and series have come.
  nlohmann::ordered_json save() const;
  /// Takes what `save` gave; tables and series that are opened from now on are continued.
  void resume(const nlohmann::ordered_json &saved);

private:
  MPI_Comm comm;
  std::map<std::string, std::shared_ptr<CsvFile>> tables;
  std::map<std::string, std::shared_ptr<PictureSeries>> series;
  std::map<std::string, std::uint64_t> sizes_before;
  std::map<std::string, PictureSeries::Files> files_before;
};

} // namespace eunoe

#endif
