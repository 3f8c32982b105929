#include <eunoe/solids/scheduled_motion.h>

namespace eunoe {

RigidState StrokeMotion::at(const double time) const
{
  RigidState state;
  state.centre = start;
  for (const Stroke &stroke : strokes) {
    if (time < stroke.start)
      break;
    const double rest = time - stroke.start;
    if (rest >= stroke.duration) {
      state.centre += stroke.displacement;
      continue;
    }
    const double s = rest / stroke.duration;
    state.centre += s * s * (3. - 2. * s) * stroke.displacement;
    state.velocity = 6. * s * (1. - s) / stroke.duration * stroke.displacement;
  }
  return state;
}

RigidState PassMotion::at(const double time) const
{
  RigidState state;
  state.centre = start;
  for (auto pass = passes.rbegin(); pass != passes.rend(); ++pass)
    if (time >= *pass) {
      const bool moving = time < *pass + duration;
      state.centre += (moving ? time - *pass : duration) * velocity;
      if (moving)
        state.velocity = velocity;
      else
        state.centre += parking;
      break;
    }
  return state;
}

} // namespace eunoe
