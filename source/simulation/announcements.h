#ifndef eunoe_source_simulation_announcements_h
#define eunoe_source_simulation_announcements_h

// A word before what takes more than seconds, so that nobody waits in silence.

namespace eunoe {

class Log;
class Parameters;
struct Background;

/// Before the insertion is made.
void announce_insertion(const Parameters &parameters, Log &log);

/// Before the mesh is made.
void announce_mesh(const Background &background, Log &log);

} // namespace eunoe

#endif
