#ifndef eunoe_tests_rolling_sphere_h
#define eunoe_tests_rolling_sphere_h

// A sphere with rolling resistance that lies on a plane, level or not.

#include "../spheres.h"

#include <array>

namespace test {

constexpr double g = 9.81, rolling_friction = 0.1;
/// Direction of the descent, and of the spin with which the sphere rolls that way.
const Vec3 along = {0.8, -0.6, 0.}, axis = {0.6, 0.8, 0.};

/// The sphere at rest; @p slope is the tangent of the plane's angle.
inline Scene rolling_scene(const std::string &rolling, double slope = 0.,
                           double viscous_damping = 0.3)
{
  Scene s;
  s.floor = true;
  s.rolling = rolling;
  s.time_step = 1e-6;
  s.particle.restitution = 0.5;
  s.particle.friction = 0.5;
  s.particle.rolling_friction = rolling_friction;
  s.particle.rolling_viscous_damping = viscous_damping;
  s.wall = s.particle;
  const double angle = std::atan(slope);
  s.gravity = g * std::sin(angle) * along - Vec3{0., 0., g * std::cos(angle)};
  s.spheres = {resting_sphere(s)};
  return s;
}

/// Spin about the axis at the time @p first and at the end.
inline std::array<double, 2> spins(const Scene &scene, double first)
{
  std::array<double, 2> spin = {};
  run(scene, [&](Simulation &simulation) {
    const Sphere s = spheres_of(simulation)[0];
    spin[simulation.time() > first * (1. + 1e-12)] = dot(s.w, axis);
  });
  return spin;
}

} // namespace test

#endif
