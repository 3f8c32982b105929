// Twist, relative spin about the normal, is not rolling: neither friction nor EPSD brakes it. The
// constant torque of Zhou et al. (1999) acts against the whole relative spin.
// Reference: the torque mu_r R |F_n| over an elastic impact takes mu_r R times the momentum.

#include "../spheres.h"

using namespace test;

namespace {

constexpr double radius = 0.5e-3, speed = 0.5, w = 5000., friction = 0.5;

/// Share of its spin that a sphere loses in an elastic impact while it spins about the normal.
double lost_twist(const std::string &rolling, const Vec3 &normal, bool floor)
{
  Scene s;
  s.rolling = rolling;
  s.particle.friction = s.particle.rolling_friction = friction;
  s.wall = s.particle;
  meet(s, floor, radius, speed, normal, {{w * normal, -w * normal}});
  return norm(run(s)[0].w - w * normal) / w;
}

/// The same by momentum: the effective radius is that of the sphere or half of it.
double reference(const std::string &rolling, bool floor)
{
  const double effective_radius = floor ? radius : 0.5 * radius;
  return rolling == "constant"
             ? friction * effective_radius * 2. * speed / (0.4 * radius * radius) / w
             : 0.;
}

} // namespace

EUNOE_MPI_TEST()
{
  for (const std::string rolling : {"none", "constant", "epsd"}) {
    const auto check = [&](const std::string &where, const Vec3 &normal, bool floor = false) {
      check_close(rolling + ", " + where, lost_twist(rolling, normal, floor),
                  reference(rolling, floor), 1e-5);
    };
    check("along x", {1., 0., 0.});
    check("along y", {0., 1., 0.});
    check("along z", {0., 0., 1.});
    check("oblique", {0.48, 0.64, 0.6});
    check("on the floor", {0., 0., -1.}, true);
  }
}
