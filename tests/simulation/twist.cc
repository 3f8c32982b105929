// Twist, relative spin about the normal, is not rolling: neither rolling resistance nor friction
// brakes it. The relative spin in the plane of the contact is then only round-off, in whose
// direction the constant torque must not act for long.

#include "../spheres.h"

using namespace test;

namespace {

/// Share of its spin that a sphere loses in an elastic impact while it spins about the normal.
double lost_twist(const std::string &rolling, const Vec3 &normal, bool floor)
{
  const double radius = 0.5e-3, speed = 0.5, w = 1000.;
  Scene s;
  s.rolling = rolling;
  s.particle.friction = s.particle.rolling_friction = 0.5;
  s.wall = s.particle;
  meet(s, floor, radius, speed, normal, {{w * normal, -w * normal}});
  return norm(run(s)[0].w - w * normal) / w;
}

} // namespace

EUNOE_MPI_TEST()
{
  for (const std::string rolling : {"none", "constant", "epsd"}) {
    const Vec3 oblique = {0.48, 0.64, 0.6};
    check_close(rolling + ", along x", lost_twist(rolling, {1., 0., 0.}, false), 0., 1e-6);
    check_close(rolling + ", along y", lost_twist(rolling, {0., 1., 0.}, false), 0., 1e-6);
    check_close(rolling + ", along z", lost_twist(rolling, {0., 0., 1.}, false), 0., 1e-6);
    check_close(rolling + ", oblique", lost_twist(rolling, oblique, false), 0., 1e-6);
    check_close(rolling + ", on the floor", lost_twist(rolling, {0., 0., -1.}, true), 0., 1e-6);
  }
}
