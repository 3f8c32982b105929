#ifndef eunoe_simulation_lethe_notes_h
#define eunoe_simulation_lethe_notes_h

#include <eunoe/core/input_file.h>

namespace eunoe {

/// What a user of Lethe should know of an input that was written for it: entries that it leaves at
/// defaults which are others here, and what Lethe computes otherwise. Nothing for an input without
/// `dimension`, which Lethe needs and Eunoe does not.
/// @param entries before they are translated
std::vector<std::string> notes_for_lethe(const std::vector<InputEntry> &entries);

} // namespace eunoe

#endif
