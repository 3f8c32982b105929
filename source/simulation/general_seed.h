#ifndef eunoe_source_simulation_general_seed_h
#define eunoe_source_simulation_general_seed_h

#include <eunoe/core/input_file.h>

namespace eunoe {

/// Entries that give @p seed to all random numbers of a run: to every entry that is called 'seed'
/// or '... seed', also to those that are added later. Numbers for different purposes are
/// independent though their seeds are equal.
/// @param known all entries of the run
/// @param given what the user wrote; a seed that loses is noted in @p problems as a warning
/// @param makes_insertion whether a process does that itself, and refuses entries for it
std::vector<InputEntry> turned_seeds(int seed, const EntryValues &known,
                                     const std::vector<InputEntry> &given, bool makes_insertion,
                                     Problems &problems);

} // namespace eunoe

#endif
