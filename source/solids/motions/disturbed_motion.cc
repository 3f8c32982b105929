#include <eunoe/solids/disturbed_motion.h>

#include <cmath>

namespace eunoe {

RigidState VibratingMotion::at(const double time) const
{
  RigidState state = motion->at(time);
  state.centre += std::sin(pulsation * time) * amplitude;
  state.velocity += pulsation * std::cos(pulsation * time) * amplitude;
  return state;
}

RigidState YieldingMotion::at(const double time) const
{
  RigidState state = motion->at(time);
  for (const Interval &interval : intervals) {
    const double s = (time - interval.start) / interval.duration;
    if (s <= 0. || s >= 1.)
      continue;
    const double sine = std::sin(M_PI * s);
    state.centre += sine * sine * excursion;
    state.velocity += M_PI / interval.duration * std::sin(2. * M_PI * s) * excursion;
  }
  return state;
}

} // namespace eunoe
