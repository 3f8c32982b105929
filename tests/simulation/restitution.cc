// Impacts of pairs and on walls have the prescribed restitution, at any speed and any ratio of
// sizes, and the overlap is that of the damped impact (Tsuji 1992; Chung and Ooi 2011, test 3).
//
// For e = 0 the damping is critical: the overlap of the oscillator in `Impact` is then
// y = v t exp(-t / t_0). The contact never ends; the speed of rebound rises to exp(-2) of that of
// impact and then falls to zero, while the overlap tends to zero from above.

#include "../spheres.h"

using namespace test;

namespace {

struct Outcome
{
  double speed, fastest, deepest, overlap; ///< positive in rebound (m/s, m)
};

/// A head-on impact of a sphere on another one at rest or on the floor.
/// @param duration over that of the elastic impact
Outcome impact(Scene &scene, const Impact &impact, double duration)
{
  Sphere &first = scene.spheres[0];
  const bool pair = scene.spheres.size() == 2;
  const double touching = first.radius() + (pair ? scene.spheres[1].radius() : 0.);
  scene.floor = !pair;
  first.v.z = -impact.speed;
  first.x.z = touching + (pair ? scene.spheres[1].x.z : 0.);
  Impact elastic = impact;
  elastic.damping = 0.;
  scene.time_step = elastic.duration() / 10000.;
  scene.time_end = duration * elastic.duration();
  Outcome outcome = {};
  run(scene, [&](Simulation &simulation) {
    const std::vector<Sphere> s = spheres_of(simulation);
    outcome.speed = s[0].v.z - (pair ? s[1].v.z : 0.);
    outcome.overlap = touching - s[0].x.z + (pair ? s[1].x.z : 0.);
    outcome.fastest = std::max(outcome.fastest, outcome.speed);
    outcome.deepest = std::max(outcome.deepest, outcome.overlap);
  });
  return outcome;
}

/// Restitution and overlap to 0.1 %.
void check_restitution(const std::string &name, Scene scene, const Impact &reference)
{
  const double e = scene.particle.restitution;
  const std::string with = name + ", e = " + format(e) + ": ";
  if (e > 0.) {
    const Outcome outcome = impact(scene, reference, 3.);
    check(with + "has parted", outcome.overlap < 0.);
    check_relative(with + "restitution", outcome.speed / reference.speed, e, 1e-3);
    check_relative(with + "overlap", outcome.deepest, reference.overlap(), 1e-3);
  } else {
    const Outcome outcome = impact(scene, reference, 30.);
    check_relative(with + "fastest rebound", outcome.fastest / reference.speed, std::exp(-2.),
                   1e-3);
    check_close(with + "speed in the end", outcome.speed / reference.speed, 0., 1e-4);
    check(with + "never parts", outcome.overlap > 0.);
    check_relative(with + "overlap", outcome.deepest, reference.overlap(), 1e-3);
  }
}

} // namespace

EUNOE_MPI_TEST()
{
  Scene scene;
  scene.density = 2500.;
  for (const double e : {0., 0.3, 0.6, 0.9, 1.}) {
    scene.particle.restitution = scene.wall.restitution = e;
    scene.spheres = {Sphere(), Sphere()};
    const double m = scene.mass(scene.spheres[0]);
    check_restitution("equal spheres", scene,
                      Impact(scene.particle, scene.particle, 0.5 * m, 0.25e-3, 0.1));
    scene.spheres[1].diameter = 0.3e-3;
    const double m1 = scene.mass(scene.spheres[1]);
    check_restitution(
        "unlike spheres", scene,
        Impact(scene.particle, scene.particle, m * m1 / (m + m1), 0.5e-3 * 0.15e-3 / 0.65e-3, 2.));
    scene.spheres.pop_back();
    check_restitution("wall", scene, Impact(scene.particle, scene.wall, m, 0.5e-3, 0.5));
  }

  // Sphere and wall of different restitution and stiffness.
  scene.particle.restitution = 0.9;
  scene.wall.restitution = 0.45;
  scene.wall.young_modulus = 5e7;
  const Impact reference(scene.particle, scene.wall, scene.mass(scene.spheres[0]), 0.5e-3, 0.5);
  check_relative("harmonic mean with the wall", impact(scene, reference, 3.).speed / 0.5, 0.6,
                 1e-3);

  // Chung and Ooi, test 3: elastic limits of alumina and cast iron, and any restitution.
  const struct
  {
    const char *name;
    double young, poisson, density, overlap, force, duration;
  } metals[] = {{"alumina", 380e9, 0.23, 4000., 8.09e-6, 615., 6.10e-6},
                {"cast iron", 100e9, 0.25, 7000., 17.19e-6, 507., 12.97e-6}};
  for (const auto &metal : metals) {
    scene.particle.young_modulus = metal.young;
    scene.particle.poisson_ratio = metal.poisson;
    scene.density = metal.density;
    scene.spheres[0].diameter = 5e-3;
    for (const double e : {0.2, 0.4, 0.8, 1.}) {
      scene.particle.restitution = e;
      scene.wall = scene.particle;
      scene.wall.young_modulus = 1e20;
      const Impact metallic(scene.particle, scene.wall, scene.mass(scene.spheres[0]), 2.5e-3, 3.9);
      check_restitution(metal.name, scene, metallic);
      if (e == 1.) {
        const std::string published = metal.name + std::string(": published ");
        check_relative(published + "overlap", metallic.overlap(), metal.overlap, 1e-3);
        check_relative(published + "force", metallic.force(), metal.force, 1e-3);
        check_relative(published + "duration", metallic.duration(), metal.duration, 1e-3);
      }
    }
  }
}
