#ifndef eunoe_discovery_stages_verification_h
#define eunoe_discovery_stages_verification_h

#include <eunoe/discovery/stages/stages.h>

namespace eunoe::discovery {

/// Whether there are runs at the fitted amplitudes, or near them.
bool is_verified(const StudyState &study, const Fit &fit);

/// Runs replicates at each of some fits, all at once, and compares them with the emulator.
/// @param number of further replicates for each fit
/// @returns a row for each: amplitudes, number of replicates, and the distance between their mean
///   and the emulator's prediction (1: as large as noise alone would make it)
Table verify(StudyState &study, const std::vector<Fit> &fits, unsigned int number);

} // namespace eunoe::discovery

#endif
