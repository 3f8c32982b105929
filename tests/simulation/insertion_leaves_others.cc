// Inserting a particle far away does not disturb particles in contact: a damped collision with
// friction, rolling resistance and cohesion gives the same bits with and without the insertion.

#include "../spheres.h"

using namespace test;

namespace {

Scene collision()
{
  Scene s;
  s.dmt = true;
  s.rolling = "epsd";
  s.particle.restitution = 0.5;
  s.particle.friction = 0.3;
  s.particle.rolling_friction = 0.1;
  s.particle.surface_energy = 0.001;
  s.gravity = {0., 0., -9.81};
  s.spheres = {{{-0.5e-3, 0., 0.}, {0.2, 0.1, 0.}, {0., 0., 50.}, 1e-3},
               {{0.5e-3, 0.1e-3, 0.}, {-0.2, 0., 0.}, {0., 10., 0.}, 1e-3}};
  s.time_step = 1e-6;
  s.time_end = 3e-4;
  return s;
}

} // namespace

EUNOE_MPI_TEST()
{
  const Scene scene = collision();
  const std::vector<Sphere> undisturbed = run(scene);
  const std::vector<Sphere> disturbed = run(scene, [&](Simulation &simulation) {
    if (simulation.step_number() != 50)
      return;
    NewParticle guest;
    guest.id = simulation.take_ids(1);
    guest.radius = 0.5e-3;
    guest.mass = sphere_mass(guest.radius, scene.density);
    guest.position = {5e-3, 5e-3, 5e-3};
    Delivery delivery;
    delivery.particles.push_back(guest);
    simulation.insert_and_remove(delivery, {});
  });
  check("one more in the end", disturbed.size() == 3 && undisturbed.size() == 2);
  for (std::size_t k = 0; k < 2; ++k)
    check("sphere " + std::to_string(k),
          disturbed[k].x == undisturbed[k].x && disturbed[k].v == undisturbed[k].v &&
              disturbed[k].w == undisturbed[k].w,
          "differs by " + format(norm(disturbed[k].v - undisturbed[k].v)) + " m/s and " +
              format(norm(disturbed[k].w - undisturbed[k].w)) + " rad/s");
}
