#include <eunoe/core/random.h>
#include <eunoe/processes/loose_powder.h>

namespace eunoe {

Delivery loose_powder(Simulation &simulation, const unsigned int type_number, const std::size_t n,
                      const Vec3 &velocity,
                      const std::function<Vec3(std::size_t k, ParticleId id)> &place)
{
  const ParticleType &type = simulation.get_parameters().physics.types[type_number];
  const auto sizes = type.sizes.make();
  const ParticleId first = simulation.take_ids(n);
  const auto [begin, end] = share_of(n, simulation.communicator());
  Delivery delivery;
  for (std::size_t k = begin; k < end; ++k) {
    NewParticle particle;
    particle.id = first + static_cast<ParticleId>(k);
    particle.type = static_cast<int>(type_number);
    particle.radius = 0.5 * sizes->diameter(uniform(type.sizes.seed, Draw::size, particle.id));
    particle.mass = sphere_mass(particle.radius, type.density);
    particle.position = place(k, particle.id);
    particle.velocity = velocity;
    delivery.particles.push_back(particle);
  }
  return delivery;
}

} // namespace eunoe
