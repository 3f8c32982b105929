// A sphere with rolling resistance on a plane. Constant torque: linear decay of the spin, motion on
// an incline only above tan(angle) = mu_r. EPSD: the same, once its spring is mobilised.

#include "rolling_sphere.h"

using namespace test;

namespace {

const double radius = 0.5e-3;

void check_decay(const std::string &rolling)
{
  // Without friction the torque brakes the inertia 2/5 m R^2, in rolling it brakes 7/5 m R^2.
  const double first = 0.002, second = 0.01;
  Scene s = rolling_scene(rolling);
  s.time_end = second;
  s.spheres[0].w = 100. * axis;
  s.particle.friction = 0.;
  std::array<double, 2> spin = spins(s, first);
  check_relative(rolling + ": decay of a spin without friction", spin[0] - spin[1],
                 2.5 * rolling_friction * g / radius * (second - first), 1e-3);

  s.particle.friction = 0.5;
  s.spheres[0].v = 100. * radius * along;
  spin = spins(s, first);
  check_relative(rolling + ": decay of a roll", spin[0] - spin[1],
                 5. / 7. * rolling_friction * g / radius * (second - first), 1e-3);
  const Sphere end = run(s)[0];
  check_relative(rolling + ": it rolls", dot(end.v, along), dot(end.w, axis) * radius, 1e-3);
}

/// The viscous torque mu_r R^2 |F| w lets a spin decay exponentially.
void check_viscous_decay()
{
  constexpr double resistance = 10.; // s/m
  Scene s = rolling_scene("viscous");
  s.particle.rolling_friction = s.wall.rolling_friction = resistance;
  const double first = 0.002, second = 0.01;
  s.time_end = second;
  s.spheres[0].w = 100. * axis;
  s.particle.friction = 0.;
  std::array<double, 2> spin = spins(s, first);
  check_relative("viscous: decay of a spin without friction", std::log(spin[0] / spin[1]),
                 2.5 * resistance * g * (second - first), 1e-3);
  s.particle.friction = 0.5;
  s.spheres[0].v = 100. * radius * along;
  spin = spins(s, first);
  check_relative("viscous: decay of a roll", std::log(spin[0] / spin[1]),
                 5. / 7. * resistance * g * (second - first), 2e-3);
}

void check_incline(const std::string &rolling)
{
  Scene s = rolling_scene(rolling, 0.9 * rolling_friction);
  const double t = s.time_end = 0.05;
  const double free_way = 0.5 * 5. / 7. * g * std::sin(std::atan(0.9 * rolling_friction)) * t * t;
  Sphere middle;
  Sphere end = run(s, [&](Simulation &simulation) {
    if (simulation.time() < 0.5 * t)
      middle = spheres_of(simulation)[0];
  })[0];
  // EPSD's spring gives way by an angle of d / (2.25 mu_r R) before it holds.
  check_close(rolling + ": stays on a slope of 0.9 mu_r",
              dot(end.x - s.spheres[0].x, along) / free_way, 0., 2e-3);
  if (rolling == "epsd")
    check_close(rolling + ": does not creep", norm(end.x - middle.x) / free_way, 0., 1e-6);

  s = rolling_scene(rolling, 2. * rolling_friction);
  s.time_end = t;
  end = run(s)[0];
  const double acceleration =
      5. / 7. * g * (2. * rolling_friction - rolling_friction) / std::hypot(1., 0.2);
  // EPSD starts late, while its spring is being mobilised.
  check_relative(rolling + ": rolls down a slope of 2 mu_r", dot(end.v, along), acceleration * t,
                 rolling == "epsd" ? 2e-2 : 1e-3);
  check_relative(rolling + ": rolls", dot(end.w, axis) * radius, dot(end.v, along), 1e-3);
}

} // namespace

EUNOE_MPI_TEST()
{
  check_decay("constant");
  check_decay("epsd");
  check_viscous_decay();
  check_incline("constant");
  check_incline("epsd");
}
