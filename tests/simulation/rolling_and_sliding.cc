// A sphere on a plane, without rolling resistance: from slip to roll, and down an incline rolling
// or sliding. Against the equations of motion of a rigid sphere.

#include "../spheres.h"

using namespace test;

namespace {

const double g = 9.81, radius = 0.5e-3;

Scene scene(double friction)
{
  Scene s;
  s.floor = true;
  s.time_step = 1e-6;
  s.half_width = 20e-3;
  s.particle.restitution = s.wall.restitution = 0.5;
  s.particle.friction = s.wall.friction = friction;
  s.particle.rolling_friction = 0.1;
  return s;
}

void slip_to_roll(double friction)
{
  const std::string name = "slip to roll, friction " + format(friction) + ": ";
  Scene s = scene(friction);
  s.gravity = {0., 0., -g};
  const double u0 = 0.1, end_of_slip = 2. * u0 / (7. * friction * g);
  const Vec3 along = {0.8, -0.6, 0.};
  s.spheres = {resting_sphere(s)};
  s.spheres[0].v = u0 * along;
  s.time_end = 2. * end_of_slip;
  double worst = 0., seen_end = 0.;
  const Sphere end = run(s, [&](Simulation &simulation) {
    const Sphere now = spheres_of(simulation)[0];
    const double t = simulation.time(), u = dot(now.v, along);
    if (t < 0.98 * end_of_slip)
      worst = std::max(worst, std::abs(u - (u0 - friction * g * t)) / u0);
    if (seen_end == 0. && std::abs(u - 5. / 7. * u0) < 1e-3 * u0)
      seen_end = t;
  })[0];
  // Until the spring is stretched, a few steps, friction is below its limit.
  check_close(name + "decelerates at mu g", worst, 0., 1e-3);
  check_relative(name + "end of the slip", seen_end, end_of_slip, 1e-2);
  check_relative(name + "velocity in the end", dot(end.v, along), 5. / 7. * u0, 1e-4);
  check_relative(name + "rolls", dot(end.w, cross({0., 0., 1.}, along)) * radius, dot(end.v, along),
                 1e-4);
  // m R u + I w holds whatever the law of friction is.
  check_relative(name + "angular momentum about the line of contact",
                 dot(end.v, along) + 0.4 * radius * dot(end.w, cross({0., 0., 1.}, along)), u0,
                 1e-12);
}

void incline(double friction, double degrees)
{
  const std::string name =
      "incline of " + format(degrees) + " degrees, friction " + format(friction) + ": ";
  const double angle = degrees * M_PI / 180., t = 0.03;
  const bool rolls = friction >= 2. / 7. * std::tan(angle);
  Scene s = scene(friction);
  s.gravity = {g * std::sin(angle), 0., -g * std::cos(angle)};
  s.spheres = {resting_sphere(s)};
  s.time_end = t;
  const Sphere end = run(s)[0];
  const double acceleration =
      rolls ? 5. / 7. * g * std::sin(angle) : g * (std::sin(angle) - friction * std::cos(angle));
  const double spin = rolls ? acceleration / radius : 2.5 * friction * g * std::cos(angle) / radius;
  check_relative(name + (rolls ? "rolls" : "slides") + ", velocity", end.v.x, acceleration * t,
                 1e-3);
  check_relative(name + "spin", end.w.y, spin * t, 1e-3);
  check_relative(name + "distance", end.x.x, 0.5 * acceleration * t * t, 2e-3);
}

} // namespace

EUNOE_MPI_TEST()
{
  slip_to_roll(0.1);
  slip_to_roll(0.4);
  incline(0.6, 10.);
  incline(0.6, 45.);
  // Close to both sides of 2/7 tan(30 degrees) = 0.165.
  incline(0.175, 30.);
  incline(0.155, 30.);
  incline(0.1, 60.);
  incline(0., 20.);
}
