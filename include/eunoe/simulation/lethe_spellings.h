#ifndef eunoe_simulation_lethe_spellings_h
#define eunoe_simulation_lethe_spellings_h

#include <eunoe/core/input_file.h>

namespace eunoe {

/// Turns what input files for Lethe say in older or other words into the entries of this program,
/// with a line for each that gives the present name; removes entries that only flows of fluids
/// need, and refuses entries that are out of scope (two dimensions, heat between particles).
///
/// Names and meanings: Lethe's documentation and sources, versions of 2023 to 2026.
void translate_lethe(std::vector<InputEntry> &entries, Problems &problems);

} // namespace eunoe

#endif
