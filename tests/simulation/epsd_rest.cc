// A sphere with EPSD's rolling resistance on a plane rolls to rest and stays where it is (Ai et al.
// 2011); on the way its dashpot brakes it as the formulas for either inertia predict.

#include "rolling_sphere.h"

using namespace test;

namespace {

const double radius = 0.5e-3;

Scene scene(const std::string &more)
{
  Scene s = rolling_scene("epsd");
  s.more = "subsection model parameters\n" + more + "end\n";
  return s;
}

/// Stiffness of EPSD's spring, angle at which it is mobilised, and its damping coefficient.
struct Epsd
{
  double stiffness, angle, damper;

  Epsd(const Scene &s, bool about_contact)
  {
    const double load = -s.mass(s.spheres[0]) * s.gravity.z;
    const double overlap = radius - s.spheres[0].x.z;
    const double arm = rolling_friction * radius;
    stiffness = 2.25 * load / overlap * arm * arm;
    angle = load * arm / stiffness;
    const double inertia = (about_contact ? 3.5 : 1.) * s.inertia(s.spheres[0]);
    damper = 2. * s.particle.rolling_viscous_damping * std::sqrt(inertia * stiffness);
  }
};

void check_rest(const std::string &inertia)
{
  const std::string name = "inertia about the " + inertia + ": ";
  Scene s = scene(Scene::entry("epsd inertia", inertia));
  const double v = 0.02;
  s.spheres[0].v = v * along;
  s.spheres[0].w = v / radius * axis;
  const double braking = 5. / 7. * rolling_friction * g;
  s.time_end = 10. * v / braking;
  Sphere middle;
  const Sphere end = run(s, [&](Simulation &simulation) {
    if (simulation.time() < 0.5 * s.time_end)
      middle = spheres_of(simulation)[0];
  })[0];
  // Before the spring is mobilised the whole dashpot brakes too, which costs a little speed.
  const Epsd epsd(s, inertia == "contact point");
  const double lost = epsd.damper * epsd.angle / (3.5 * s.inertia(end)) * radius;
  check(name + "the dashpot is felt", lost > 0.005 * v);
  check_relative(name + "way to rest", dot(end.x, along), 0.5 * (v - lost) * (v - lost) / braking,
                 2e-3);
  check_close(name + "spin is gone", norm(end.w) * radius / v, 0., 1e-15);
  check_close(name + "does not creep", norm(end.x - middle.x) / radius, 0., 1e-12);
}

/// With a share f of the dashpot left, the spin relaxes exponentially.
void check_share()
{
  const double f = 0.1, first = 0.002, second = 0.01;
  Scene s = scene(Scene::entry("f coefficient", f));
  s.spheres[0].v = 100. * radius * along;
  s.spheres[0].w = 100. * axis;
  s.time_end = second;
  const Epsd epsd(s, true);
  const double rate = f * epsd.damper / (3.5 * s.inertia(s.spheres[0]));
  const double balance = epsd.stiffness * epsd.angle / (f * epsd.damper);
  const std::array<double, 2> spin = spins(s, first);
  check_relative("decay of a roll with f = 0.1", spin[1],
                 (spin[0] + balance) * std::exp(-rate * (second - first)) - balance, 1e-3);
}

} // namespace

EUNOE_MPI_TEST()
{
  check_rest("contact point");
  check_rest("centre");
  check_share();
}
