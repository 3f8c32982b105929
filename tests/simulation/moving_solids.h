#ifndef eunoe_tests_moving_solids_h
#define eunoe_tests_moving_solids_h

// Solids for the tests of the parts of a simulation.

#include <eunoe/solids/half_space.h>

#include "../tests.h"

namespace test {

/// A floor that rises along z from a given time on.
class Rise : public Motion
{
public:
  Rise(double speed, double start) : speed(speed), start(start) {}

  RigidState at(double time) const override
  {
    RigidState state;
    state.centre.z = time < start ? 0. : speed * (time - start);
    state.velocity.z = time < start ? 0. : speed;
    return state;
  }

private:
  const double speed, start;
};

inline Solid rising(const std::string &name, double speed, double start = 0.)
{
  Solid solid;
  solid.name = name;
  solid.shape = std::make_shared<HalfSpace>(Vec3(), Vec3{0., 0., 1.});
  solid.motion = std::make_shared<Rise>(speed, start);
  return solid;
}

} // namespace test

#endif
