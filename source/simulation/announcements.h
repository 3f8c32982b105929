#ifndef eunoe_source_simulation_announcements_h
#define eunoe_source_simulation_announcements_h

// Announces steps of the set-up that take more than seconds, so that the user knows why it waits.

namespace eunoe {

class Log;
struct Background;

/// Before the mesh is made.
void announce_mesh(const Background &background, Log &log);

} // namespace eunoe

#endif
