// Elastic normal impact of two spheres and of a sphere on a plane: largest overlap, largest force
// and duration, against Hertz's theory and the values of Chung and Ooi (2011), tests 1 and 2.

#include "../spheres.h"

using namespace test;

namespace {

struct Published
{
  double overlap, force, duration; ///< four digits (m, N, s)
};

void check_impact(const std::string &name, Scene scene, double mass, double radius, double speed,
                  const Published &published)
{
  const Impact hertz(scene.particle, scene.floor ? scene.wall : scene.particle, mass, radius,
                     speed);
  scene.time_step = hertz.duration() / 5000.;
  scene.time_end = 1.2 * hertz.duration();
  const double gap = 0.1 * speed * hertz.duration();
  const double touching = scene.floor ? scene.spheres[0].radius() : scene.spheres[0].diameter;
  const double share = scene.floor ? 1. : 0.5;
  scene.spheres[0].x.z = (touching + gap) * share;
  scene.spheres[0].v.z = -speed * share;
  if (!scene.floor) {
    scene.spheres.push_back(scene.spheres[0]);
    scene.spheres[1].x.z *= -1.;
    scene.spheres[1].v.z *= -1.;
  }

  double deepest = 0., strongest = 0., last_speed = 0., last_time = 0.;
  const std::vector<Sphere> end = run(scene, [&](Simulation &simulation) {
    const Sphere s = spheres_of(simulation)[0];
    deepest = std::max(deepest, touching - s.x.z / share);
    if (last_time > 0.)
      strongest = std::max(strongest,
                           scene.mass(s) * (s.v.z - last_speed) / (simulation.time() - last_time));
    last_speed = s.v.z;
    last_time = simulation.time();
  });
  const double speed_after = end[0].v.z / share;
  const double duration = last_time - (end[0].x.z / share - touching) / speed_after - gap / speed;

  const double half_digit = 0.5e-3;
  check_relative(name + ": published overlap", deepest, published.overlap, half_digit);
  check_relative(name + ": published force", strongest, published.force, half_digit);
  check_relative(name + ": published duration", duration, published.duration, half_digit);
  // The relative error of velocity Verlet is a few times (step / duration)^2.
  const double second_order = 1e-6;
  check_relative(name + ": overlap", deepest, hertz.overlap(), second_order);
  check_relative(name + ": force", strongest, hertz.force(), second_order);
  check_relative(name + ": duration", duration, hertz.duration(), second_order);
  check_relative(name + ": speed", speed_after, speed, second_order);
}

void two_spheres(const std::string &name, double young, double poisson, double density,
                 const Published &published)
{
  Scene scene;
  scene.particle.young_modulus = young;
  scene.particle.poisson_ratio = poisson;
  scene.particle.friction = 0.35;
  scene.density = density;
  scene.spheres.resize(1);
  scene.spheres[0].diameter = 20e-3;
  check_impact(name, scene, 0.5 * scene.mass(scene.spheres[0]), 5e-3, 20., published);
}

void sphere_on_plane(const std::string &name, double young, double poisson, double density,
                     const Published &published)
{
  Scene scene;
  scene.floor = true;
  scene.particle.young_modulus = young;
  scene.particle.poisson_ratio = poisson;
  scene.wall = scene.particle;
  scene.wall.young_modulus *= 1000.;
  scene.density = density;
  scene.spheres.resize(1);
  scene.spheres[0].diameter = 0.2;
  check_impact(name, scene, scene.mass(scene.spheres[0]), 0.1, 0.2, published);
}

} // namespace

EUNOE_MPI_TEST()
{
  two_spheres("glass", 48e9, 0.2, 2800., {274.1e-6, 10.70e3, 40.34e-6});
  two_spheres("limestone", 20e9, 0.25, 2500., {368.3e-6, 7.108e3, 54.20e-6});
  sphere_on_plane("aluminium alloy", 70e9, 0.3, 2699., {49.72e-6, 11.37e3, 731.7e-6});
  sphere_on_plane("magnesium alloy", 40e9, 0.35, 1800., {52.12e-6, 7.233e3, 767.1e-6});
}
