// Adhesive bodies in motion, without damping. The work of a cycle of contact is known in closed
// form, for the adhesion of Johnson, Kendall and Roberts (Thornton, Ning 1998) and for liquid
// bridges (Willett et al. 2000): a body with more kinetic energy rebounds with the rest, one with
// less sticks. A sphere hangs on up to the pull-off force 3/2 pi w R.

#include "../spheres.h"

using namespace test;

namespace {

const double surface_energy = 0.05, tension = 0.01, share = 1e-3;

struct Adhesion
{
  std::string name, entries;
  double time_step, work, reach; ///< work of a cycle (J) and separation at which it ends (m)
};

/// @param radius effective (m)
Adhesion jkr(double radius, const Material &m)
{
  const double young = m.young_modulus / (2. * (1. - m.poisson_ratio * m.poisson_ratio));
  const double work = 2. * surface_energy;
  const double torn = std::cbrt(M_PI * work * radius * radius / (8. * young));
  return {"JKR",
          "subsection model parameters\n" +
              Scene::entry("particle particle contact force method", "JKR") +
              Scene::entry("particle wall contact force method", "JKR") + "end\n",
          5e-9, 7.0898 * std::cbrt(std::pow(work, 5) * std::pow(radius, 4) / (young * young)),
          3. * torn * torn / radius};
}

/// @param radius effective (m)
Adhesion bridge(double radius, double particle_radius)
{
  const double volume = share * 4. / 3. * M_PI * std::pow(particle_radius, 3);
  const double reach = std::cbrt(volume), derjaguin = 2. * radius;
  const double stretch = std::sqrt(derjaguin / volume), root = std::sqrt(10. - 1.05 * 1.05);
  const double integral =
      2. / root * (std::atan((5. * stretch * reach + 1.05) / root) - std::atan(1.05 / root));
  return {"bridge",
          "subsection model parameters\nsubsection capillary bridges\n" +
              Scene::entry("surface tension", tension) + Scene::entry("volume share", share) +
              "end\nend\n",
          5e-8, 2. * M_PI * derjaguin * tension / stretch * integral, reach};
}

Scene scene(bool floor, const Adhesion &adhesion)
{
  Scene s;
  s.floor = floor;
  s.particle.surface_energy = s.wall.surface_energy = surface_energy;
  s.spheres.resize(floor ? 1 : 2);
  s.time_step = adhesion.time_step;
  // A skin that is smaller than the range of the attraction.
  s.more = adhesion.entries + "subsection model parameters\nsubsection contact detection\n" +
           Scene::entry("neighborhood threshold", 1.0005) + "end\nend\n";
  return s;
}

/// Square of the relative speed at which they part, 0 if they stick.
double square_after(Scene s, const Adhesion &adhesion, double speed)
{
  const double touching = s.floor ? s.spheres[0].radius() : s.spheres[0].diameter;
  s.spheres[0].x.z = touching + 1e-3 * adhesion.reach;
  s.spheres[0].v.z = -speed;
  s.time_end = 1.5e-4 + 12. * adhesion.reach / speed;
  const std::vector<Sphere> end = run(s);
  const double z = end[0].x.z - (s.floor ? 0. : end[1].x.z);
  const double v = end[0].v.z - (s.floor ? 0. : end[1].v.z);
  return z - touching > adhesion.reach ? v * v : 0.;
}

void check_impact(const std::string &name, const Scene &s, const Adhesion &adhesion, double mass)
{
  const double sticking = std::sqrt(2. * adhesion.work / mass);
  const double speed = 1.7 * sticking;
  check_relative(name + "what is left of the energy", square_after(s, adhesion, speed),
                 speed * speed - sticking * sticking, 3e-3);
  check(name + "too slow to part", square_after(s, adhesion, 0.98 * sticking) == 0.);
  check(name + "fast enough to part", square_after(s, adhesion, 1.02 * sticking) > 0.);
}

/// Separation of a sphere from the plane after a pull with a share of the pull-off force (m).
double gap_after_pull(double pull)
{
  const Material m;
  Scene s = scene(true, jkr(0.5e-3, m));
  s.particle.restitution = s.wall.restitution = 0.; // the strongest damping
  const double radius = s.spheres[0].radius();
  s.gravity = {0., 0., pull * 3. * M_PI * surface_energy * radius / s.mass(s.spheres[0])};
  s.spheres[0].x.z = radius - 1e-9;
  s.time_step = 5e-8;
  s.time_end = 4e-3;
  return run(s)[0].x.z - radius;
}

} // namespace

EUNOE_MPI_TEST()
{
  for (const bool floor : {false, true}) {
    const Scene plain;
    const Sphere sphere;
    const double radius = floor ? sphere.radius() : 0.5 * sphere.radius();
    const double mass = floor ? plain.mass(sphere) : 0.5 * plain.mass(sphere);
    for (const Adhesion &adhesion : {jkr(radius, plain.particle), bridge(radius, sphere.radius())})
      check_impact(adhesion.name + (floor ? " and wall: " : " of a pair: "), scene(floor, adhesion),
                   adhesion, mass);
  }
  check("hangs on at 99 % of the pull-off force", gap_after_pull(0.99) < 2e-6);
  check("falls at 101 % of the pull-off force", gap_after_pull(1.01) > 100e-6);
}
