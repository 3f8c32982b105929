#ifndef eunoe_discovery_stages_verification_h
#define eunoe_discovery_stages_verification_h

#include <eunoe/discovery/stages/stages.h>

namespace eunoe::discovery {

/// Whether there are runs to rest the fit on.
bool is_verified(const Workbench &bench, const Fit &fit);

/// Makes so many runs to rest each of some fits on, all at once.
/// @returns a row for each: where, runs that are there now, and how far they are from what the
///   emulator foresaw (1: as far as noise makes expect)
Table verify(Workbench &bench, const std::vector<Fit> &fits, unsigned int number);

} // namespace eunoe::discovery

#endif
