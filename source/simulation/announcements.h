#ifndef eunoe_source_simulation_announcements_h
#define eunoe_source_simulation_announcements_h

// A word before what takes more than seconds, so that nobody waits in silence.

namespace eunoe {

class Log;
struct Background;

/// Before the mesh is made.
void announce_mesh(const Background &background, Log &log);

} // namespace eunoe

#endif
