#ifndef eunoe_checkpoint_input_differences_h
#define eunoe_checkpoint_input_differences_h

#include <eunoe/core/input_file.h>
#include <eunoe/core/problems.h>

#include <string>

namespace eunoe {

/// Notes every entry in which two complete inputs differ and which a run must not change when it
/// continues from a checkpoint: all but those on its end, output, log, load balancing and
/// checkpoints. An entry that the program did not know then, and that has its default now, is none.
/// @param now,then all entries
/// @param changed the entries that now have other values than their defaults
/// @param checkpoint its path, for messages
void find_input_differences(const EntryValues &now, const EntryValues &then,
                            const EntryValues &changed, const std::string &checkpoint,
                            Problems &problems);

/// The same of the contents of files that both name (`named_files`).
void find_file_differences(const EntryValues &now, const EntryValues &then,
                           const std::string &checkpoint, Problems &problems);

} // namespace eunoe

#endif
