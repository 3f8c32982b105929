#ifndef eunoe_processes_powder_spreading_schedule_h
#define eunoe_processes_powder_spreading_schedule_h

#include <eunoe/processes/powder_spreading/apparatus.h>

namespace eunoe::spreading {

/// The moments of one pass (s).
struct Pass
{
  double feed;       ///< the reservoir is replenished (if it is) and the platform starts to rise
  double start;      ///< the spreader starts
  double over_plate; ///< its lowest line reaches the measuring plate ...
  double past_plate; ///< ... and leaves it
  double weighing;   ///< the mass on the plate is taken, then the plate starts to fall
  double end;        ///< the spreader has left
};

/// All passes from that of a layer on, beginning at a given time.
std::vector<Pass> make_schedule(const SpreadingParameters &parameters, const Apparatus &apparatus,
                                double beginning, unsigned int first_layer = 0);

} // namespace eunoe::spreading

#endif
