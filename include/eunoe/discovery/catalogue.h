#ifndef eunoe_discovery_catalogue_h
#define eunoe_discovery_catalogue_h

#include <eunoe/discovery/factor.h>
#include <eunoe/discovery/patch.h>

#include <set>

namespace eunoe::discovery {

/// An effect of the catalogue: its factor, and the patch that puts it into a case.
struct Effect
{
  Factor factor;
  Patch patch;
  std::string process = "all"; ///< the only process that can have it, or "all"
  std::string file;

  bool concerns(const std::string &process_name) const
  {
    return process == "all" || process == process_name;
  }
};

/// Reads the text of an effect's file; its name is that of the file. What is wrong goes to
/// @p problems.
Effect read_effect(const std::string &text, const std::string &file, Problems &problems,
                   const FileLoader &load = {});

/// Reads all effects "*.prm" in a folder, in the order of their names. Throws a UserError if the
/// folder cannot be read. Collective if @p load is.
std::vector<Effect> read_catalogue(const std::string &folder, Problems &problems,
                                   const FileLoader &load);

/// The folder of the effects that come with the program, installed or in the source tree.
std::string standard_catalogue();

/// The effects among @p all that a study looks at. Names that are unknown go to @p problems.
/// @param wanted names, or "all"
std::vector<Effect> select(const std::vector<Effect> &all, const std::vector<std::string> &wanted,
                           const std::vector<std::string> &excluded, const std::string &where,
                           Problems &problems);

} // namespace eunoe::discovery

#endif
