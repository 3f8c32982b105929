// An off-centre collision of two unlike spheres with friction, rolling resistance and cohesion: the
// same bits whichever sphere has the lower id and in a mirror, and momentum and angular momentum
// are conserved.

#include "../spheres.h"

using namespace test;

namespace {

Scene collision(const std::string &rolling)
{
  Scene s;
  s.particle.young_modulus = 1e9;
  s.particle.restitution = 0.7;
  s.particle.friction = 0.4;
  s.particle.rolling_friction = 0.1;
  s.particle.rolling_viscous_damping = 0.3;
  s.particle.surface_energy = 0.01;
  s.dmt = true;
  s.rolling = rolling;
  s.spheres = {{{-0.2e-3, 0.1e-3, -0.32e-3}, {0.4, 0.2, 1.}, {300., -100., 50.}, 0.8e-3},
               {{0.25e-3, -0.1e-3, 0.35e-3}, {-0.1, -0.3, -0.6}, {-20., 250., 100.}, 0.6e-3}};
  s.time_step = 2e-8;
  s.time_end = 4e-4;
  return s;
}

bool same(const Sphere &a, const Sphere &b)
{
  return a.x == b.x && a.v == b.v && a.w == b.w;
}

Sphere mirrored(Sphere s, unsigned int axis)
{
  s.x[axis] *= -1.;
  s.v[axis] *= -1.;
  s.w[(axis + 1) % 3] *= -1.;
  s.w[(axis + 2) % 3] *= -1.;
  return s;
}

Vec3 momentum(const Scene &scene, const std::vector<Sphere> &spheres)
{
  Vec3 sum;
  for (const Sphere &s : spheres)
    sum += scene.mass(s) * s.v;
  return sum;
}

Vec3 angular_momentum(const Scene &scene, const std::vector<Sphere> &spheres)
{
  Vec3 sum;
  for (const Sphere &s : spheres)
    sum += scene.mass(s) * cross(s.x, s.v) + scene.inertia(s) * s.w;
  return sum;
}

} // namespace

EUNOE_MPI_TEST()
{
  for (const std::string rolling : {"none", "constant", "epsd"}) {
    const Scene scene = collision(rolling);
    double deepest = 0.;
    const std::vector<Sphere> end = run(scene, [&](Simulation &simulation) {
      const std::vector<Sphere> s = spheres_of(simulation);
      deepest = std::max(deepest, s[0].radius() + s[1].radius() - norm(s[0].x - s[1].x));
    });
    check(rolling + ": they collide and part",
          deepest > 1e-6 && norm(end[0].x - end[1].x) > 0.8e-3);

    Scene swapped = scene;
    std::swap(swapped.spheres[0], swapped.spheres[1]);
    const std::vector<Sphere> other = run(swapped);
    check(rolling + ": same with swapped ids", same(other[0], end[1]) && same(other[1], end[0]));
    for (unsigned int axis = 0; axis < 3; ++axis) {
      Scene mirror = scene;
      for (Sphere &s : mirror.spheres)
        s = mirrored(s, axis);
      const std::vector<Sphere> image = run(mirror);
      check(rolling + ": same in a mirror across axis " + std::to_string(axis),
            same(mirrored(image[0], axis), end[0]) && same(mirrored(image[1], axis), end[1]));
    }

    // The momentum and spin exchanged in the collision are the scale of the errors.
    const double passed = scene.mass(end[0]) * norm(end[0].v - scene.spheres[0].v);
    const double turned = scene.inertia(end[0]) * norm(end[0].w - scene.spheres[0].w);
    check(rolling + ": spin changes hands", norm(end[0].w - scene.spheres[0].w) > 10.);
    check_close(rolling + ": momentum",
                norm(momentum(scene, end) - momentum(scene, scene.spheres)) / passed, 0., 1e-12);
    // The lever arms of friction are the radii, together longer than the distance by the overlap;
    // the resulting moment is at most the overlap times the Coulomb limit. The factor covers the
    // attractive end of the contact, where the limit follows the magnitude of the force.
    const double moment = 1.3 * deepest * scene.particle.friction * passed;
    check(rolling + ": that is little", moment < 0.05 * turned);
    check_close(rolling + ": angular momentum over what the radii as lever arms allow",
                norm(angular_momentum(scene, end) - angular_momentum(scene, scene.spheres)) /
                    moment,
                0., 1.);
  }
}
