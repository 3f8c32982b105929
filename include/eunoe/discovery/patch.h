#ifndef eunoe_discovery_patch_h
#define eunoe_discovery_patch_h

#include <eunoe/core/input_file.h>

namespace eunoe::discovery {

/// The value of an entry at an amplitude. `${...}` in @p pattern are expressions of 'amplitude' and
/// of 'base', the number in @p base. If the pattern is one expression of 'base' and base is a
/// list, it is evaluated for each of its numbers; within a list, each takes the number at its
/// place. Throws a std::invalid_argument with half a sentence.
std::string patched_value(const std::string &pattern, const std::string &base, double amplitude);

/// Entries of an input file that depend on an amplitude.
struct Patch
{
  std::vector<InputEntry> entries; ///< with patterns as values

  /// Applies the patch to the values of a case, and adds its entries to the overrides. Throws a
  /// UserError that names the entry.
  void apply(double amplitude, EntryValues &values, std::vector<std::string> &overrides) const;
};

} // namespace eunoe::discovery

#endif
