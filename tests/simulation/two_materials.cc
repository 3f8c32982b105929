// Two types of particles and walls, all of different materials: every contact takes the constants
// of its own pair. A sphere of each type hits the floor, and the two hit each other.

#include "../spheres.h"

using namespace test;

namespace {

/// The body that is hit from above: a sphere, or the floor for a negative index.
Sphere lower_body(const std::vector<Sphere> &spheres, int index)
{
  Sphere floor;
  floor.diameter = 0.;
  return index < 0 ? floor : spheres[index];
}

constexpr double radius = 0.5e-3, other_radius = 0.3e-3, other_density = 4000., speed = 0.5;

/// A case with a floor and without spheres.
/// @param other becomes the material of type 1
Scene make_scene(Material &other)
{
  Scene scene;
  scene.floor = true;
  scene.half_width = 20e-3;
  scene.density = 1500.;
  other = scene.particle;
  scene.particle.restitution = 0.9;
  other.restitution = 0.3;
  other.young_modulus = 1e8;
  other.poisson_ratio = 0.1;
  scene.wall.restitution = 0.5;
  scene.wall.young_modulus = 3e7;
  scene.wall.poisson_ratio = 0.45;
  scene.more = "subsection lagrangian physical properties\n" +
               Scene::entry("number of particle types", "2") + "subsection particle type 1\n" +
               Scene::entry("diameter", 2. * other_radius) +
               Scene::entry("density particles", other_density) +
               Scene::material(other, "particles") + "end\nend\n";
  return scene;
}

/// Adds the sphere of type 1, which an input cannot place.
void insert_guest(Simulation &simulation, const Sphere &sphere)
{
  NewParticle guest;
  guest.id = simulation.take_ids(1);
  guest.type = 1;
  guest.radius = other_radius;
  guest.mass = sphere_mass(other_radius, other_density);
  guest.position = sphere.x;
  guest.velocity = sphere.v;
  Delivery delivery;
  delivery.particles = {guest};
  simulation.insert_and_remove(delivery, {});
}

/// Sphere 0 is the host of type 0, sphere 1 the guest of type 1, -1 the floor; a sphere that is
/// neither upper nor lower is far away.
void collide(const Scene &scene, const std::string &name, int upper, int lower,
             const Impact &reference)
{
  std::vector<Sphere> start(2);
  start[0].diameter = 2. * radius;
  start[1].diameter = 2. * other_radius;
  start[0].x.z = 5e-3;
  start[1].x.z = 15e-3;
  const Sphere below = lower_body(start, lower);
  const double touching = start[upper].radius() + below.radius();
  // Just out of contact: the guest is inserted after the host, on which it does not act at once.
  start[upper].x.z = below.x.z + touching * (1. + 1e-12);
  start[upper].v.z = -speed;

  Scene s = scene;
  s.spheres = {start[0]};
  s.time_step = reference.duration() / 10000.;
  s.time_end = 4. * reference.duration();
  double deepest = 0.;
  const std::vector<Sphere> end = run(s, [&](Simulation &simulation) {
    if (simulation.step_number() == 0)
      insert_guest(simulation, start[1]);
    const std::vector<Sphere> now = spheres_of(simulation);
    deepest = std::max(deepest, touching - now[upper].x.z + lower_body(now, lower).x.z);
  });
  const double rebound = end[upper].v.z - lower_body(end, lower).v.z;
  const double d = reference.damping;
  check_relative(name + ": restitution", rebound / speed,
                 std::exp(-M_PI * d / std::sqrt(1. - d * d)), 1e-3);
  check_relative(name + ": overlap", deepest, reference.overlap(), 1e-3);
  const double m0 = sphere_mass(radius, scene.density),
               m1 = sphere_mass(other_radius, other_density);
  if (lower >= 0)
    check_relative(name + ": momentum", m0 * end[0].v.z + m1 * end[1].v.z, -m1 * speed, 1e-12);
}

} // namespace

EUNOE_MPI_TEST()
{
  Material other;
  const Scene scene = make_scene(other);
  const double m0 = sphere_mass(radius, scene.density),
               m1 = sphere_mass(other_radius, other_density);
  collide(scene, "type 0 and floor", 0, -1, Impact(scene.particle, scene.wall, m0, radius, speed));
  collide(scene, "type 1 and floor", 1, -1, Impact(other, scene.wall, m1, other_radius, speed));
  collide(scene, "type 1 and type 0", 1, 0,
          Impact(scene.particle, other, m0 * m1 / (m0 + m1),
                 radius * other_radius / (radius + other_radius), speed));
}
