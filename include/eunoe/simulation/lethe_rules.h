#ifndef eunoe_simulation_lethe_rules_h
#define eunoe_simulation_lethe_rules_h

#include <string>
#include <vector>

/// What input files for Lethe say in other words, as lists of rules. In the path of a rule a name
/// may end in '*'.
namespace eunoe::lethe_rules {

using EntryPath = std::vector<std::string>;

/// An entry with another name.
struct Renamed
{
  EntryPath path;
  std::string from, to;
};
const std::vector<Renamed> &renamed();

/// A word with another spelling; without a new one the entry is not needed.
struct Word
{
  EntryPath path;
  std::string entry, from, to;
};
const std::vector<Word> &words();

/// Numbers that have become components of one entry.
struct Components
{
  EntryPath path;
  EntryPath from; ///< three numbers, or six for two corners
  EntryPath to_path;
  std::string to;
};
const std::vector<Components> &components();

/// Entries that change nothing here.
struct Ignored
{
  EntryPath path, entries; ///< no entries: all of the subsection
  std::string why;
};
const std::vector<Ignored> &ignored();
const std::vector<Ignored> &ignored_for_heat();

/// Entries that are out of scope or have moved, unless their value is harmless.
struct Refused
{
  EntryPath path;
  std::string entry, harmless, why;
};
const std::vector<Refused> &refused();

} // namespace eunoe::lethe_rules

#endif
