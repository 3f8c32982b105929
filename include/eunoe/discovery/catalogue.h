#ifndef eunoe_discovery_catalogue_h
#define eunoe_discovery_catalogue_h

#include <eunoe/core/input_file.h>
#include <eunoe/discovery/factor.h>

#include <mpi.h>

namespace eunoe::discovery {

/// The value of an entry at an amplitude. `${...}` in @p pattern are expressions of 'amplitude' and
/// of 'base', the number in @p base. If the pattern is one expression of 'base' and base is a
/// list, it is evaluated for each of its numbers; within a list, each takes the number at its
/// place. Throws a std::invalid_argument with half a sentence.
std::string patched_value(const std::string &pattern, const std::string &base, double amplitude);

/// An effect of the catalogue, or a nuisance: a factor, and the entries that put it into a case.
struct Effect : Factor
{
  std::vector<InputEntry> entries; ///< with patterns as values
  std::string process = "all";     ///< the only process that can have it, or "all"
  std::string file;                ///< that describes it; empty for a nuisance

  /// Puts it into the values of a case, and adds its entries to the overrides. Throws a UserError
  /// that names the entry.
  void apply(double amplitude, EntryValues &values, std::vector<std::string> &overrides) const;

  bool concerns(const std::string &process_name) const
  {
    return process == "all" || process == process_name;
  }
};

/// Path of a file or folder that comes with the program, installed or in the source tree.
std::string shipped(const std::string &name);

/// Reads the text of an effect's file; its name is that of the file. What is wrong goes to
/// @p problems.
Effect read_effect(const std::string &text, const std::string &file, Problems &problems,
                   const FileLoader &load = {});

/// Reads the effects of folders, files "*.prm" in the order of their names; the folder "standard"
/// is that of the effects that come with the program. Throws a UserError if a folder cannot be
/// read; collective.
std::vector<Effect> read_effects(const std::vector<std::string> &folders, MPI_Comm comm,
                                 Problems &problems);

/// The effects among @p all that a study looks at. Names that are unknown go to @p problems.
/// @param wanted names, or "all"
std::vector<Effect> select(const std::vector<Effect> &all, const std::vector<std::string> &wanted,
                           const std::vector<std::string> &excluded, const std::string &where,
                           Problems &problems);

} // namespace eunoe::discovery

#endif
