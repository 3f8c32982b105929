// Two unlike spheres in a closed box with gravity. Elastic and without friction they keep their
// energy through hundreds of collisions; with damping it never grows; friction and rolling
// resistance take energy from every collision.

#include "../spheres.h"

using namespace test;

namespace {

const double half = 2.7e-3;

Scene box(double restitution, double friction)
{
  Scene s;
  s.half_width = half;
  s.particle.restitution = s.wall.restitution = restitution;
  s.particle.friction = s.wall.friction = friction;
  s.particle.rolling_friction = s.wall.rolling_friction = 0.1;
  s.gravity = {0., 0., -9.81};
  s.spheres = {{{-1e-3, 0.2e-3, 0.}, {0.3, 0.1, 0.7}, {}, 1e-3},
               {{1e-3, 0.1e-3, 0.2e-3}, {-0.5, -0.4, 0.2}, {}, 0.6e-3}};
  return s;
}

/// Kinetic, rotational, potential and Hertz's elastic energy (J), without that of Mindlin's spring.
struct Energy
{
  double total = 0., elastic = 0.;

  Energy(const Scene &scene, const std::vector<Sphere> &spheres)
  {
    const auto store = [&](double overlap, double radius, double young) {
      if (overlap > 0.)
        elastic += 8. / 15. * young * std::sqrt(radius) * std::pow(overlap, 2.5);
    };
    // Spheres and walls are of one material.
    const double poisson = scene.particle.poisson_ratio;
    const double young = 0.5 * scene.particle.young_modulus / (1. - poisson * poisson);
    for (const Sphere &s : spheres) {
      total += 0.5 * scene.mass(s) * norm_square(s.v) + 0.5 * scene.inertia(s) * norm_square(s.w) -
               scene.mass(s) * dot(scene.gravity, s.x);
      for (unsigned int d = 0; d < 3; ++d)
        store(std::abs(s.x[d]) + s.radius() - half, s.radius(), young);
    }
    const double r0 = spheres[0].radius(), r1 = spheres[1].radius();
    store(r0 + r1 - norm(spheres[0].x - spheres[1].x), r0 * r1 / (r0 + r1), young);
    total += elastic;
  }
};

struct Outcome
{
  // Energies over that at the start.
  double drift = 0., gain = 0.; ///< largest change since the start, largest growth in a step
  double gain_apart = 0.;       ///< largest growth from one time without contact to the next
  double left = 1.;             ///< at the end
  int contacts = 0;
};

Outcome bounce(const Scene &scene)
{
  // Potential energy counts from the floor, or relative changes would depend on the box's place.
  double floor = 0.;
  for (const Sphere &s : scene.spheres)
    floor += scene.mass(s) * scene.gravity.z * half;
  const double start = Energy(scene, scene.spheres).total - floor;
  Outcome outcome;
  double last = start, last_apart = start;
  bool touched = false;
  run(scene, [&](Simulation &simulation) {
    const Energy energy(scene, spheres_of(simulation));
    const double now = energy.total - floor;
    outcome.drift = std::max(outcome.drift, std::abs(now - start) / start);
    outcome.gain = std::max(outcome.gain, (now - last) / start);
    last = now;
    const bool touches = energy.elastic > 0.;
    outcome.contacts += touches && !touched;
    touched = touches;
    if (!touches) {
      outcome.gain_apart = std::max(outcome.gain_apart, (now - last_apart) / start);
      last_apart = now;
    }
    outcome.left = now / start;
  });
  return outcome;
}

/// A sphere hits the floor, without damping, at angles from normal to grazing.
void check_grazing(double friction)
{
  Scene s;
  s.floor = true;
  s.particle.friction = s.wall.friction = friction;
  s.spheres.resize(1);
  const double radius = s.spheres[0].radius();
  double most = 0.;
  for (const double degrees : {1., 10., 30., 45., 60., 80., 85., 89., 89.9}) {
    const double angle = degrees * M_PI / 180.;
    s.spheres[0].x = {0., 0., radius};
    s.spheres[0].v = {std::sin(angle), 0., -std::cos(angle)};
    const double duration =
        Impact(s.particle, s.wall, s.mass(s.spheres[0]), radius, std::cos(angle)).duration();
    s.time_step = duration / 2000.;
    s.time_end = 1.5 * duration;
    const Sphere after = run(s)[0];
    most = std::max(most, norm_square(after.v) + 0.4 * radius * radius * norm_square(after.w));
  }
  check("no energy from friction at any angle, friction " + format(friction), most < 1.);
}

} // namespace

EUNOE_MPI_TEST()
{
  Scene scene = box(1., 0.);
  const double rayleigh =
      PhysicalProperties::rayleigh_time(scene.spheres[1].radius(), scene.density, scene.particle);
  scene.time_end = 0.5;
  // The error of velocity Verlet shrinks with the square of the step.
  scene.time_step = 0.1 * rayleigh;
  const Outcome coarse = bounce(scene);
  scene.time_step = 0.025 * rayleigh;
  const Outcome fine = bounce(scene);
  check("hundreds of elastic collisions", coarse.contacts > 200 && fine.contacts > 200);
  check_close("energy at 10 % of the Rayleigh time", coarse.drift, 0., 4e-3);
  check_close("energy at 2.5 % of the Rayleigh time", fine.drift, 0., 4e-3 / 16.);

  for (const double e : {0.9, 0.5}) {
    const std::string name = "e = " + format(e) + ": ";
    Scene damped = box(e, 0.);
    damped.time_step = 0.1 * rayleigh;
    damped.time_end = 0.5;
    const Outcome smooth = bounce(damped);
    check(name + "collisions take energy", smooth.contacts > 10 && smooth.left < 0.1);
    check_close(name + "no growth in any step", smooth.gain, 0., 1e-12);
    for (const std::string rolling : {"none", "constant", "epsd"}) {
      damped = box(e, 0.5);
      damped.rolling = rolling;
      damped.time_step = 0.1 * rayleigh;
      damped.time_end = 0.3;
      const Outcome rough = bounce(damped);
      check_close(name + "no growth over any contact with friction, rolling " + rolling,
                  rough.contacts > 10 ? rough.gain_apart : 1., 0., 1e-12);
    }
  }

  check_grazing(0.3);
  check_grazing(1.);
}
