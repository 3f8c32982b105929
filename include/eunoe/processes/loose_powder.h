#ifndef eunoe_processes_loose_powder_h
#define eunoe_processes_loose_powder_h

#include <eunoe/simulation/simulation.h>

#include <functional>

namespace eunoe {

/// Distance of the places of loose particles over the largest diameter, and the random shifts about
/// these places.
constexpr double loose_pitch = 1.05, loose_offset = 0.05;

/// This rank's share of new particles of a type, with new ids and random sizes; collective.
/// @param n number of all ranks
/// @param velocity of each (m/s)
/// @param place of the k-th particle, which has the id (m)
Delivery loose_powder(Simulation &simulation, unsigned int type, std::size_t n,
                      const Vec3 &velocity,
                      const std::function<Vec3(std::size_t k, ParticleId id)> &place);

} // namespace eunoe

#endif
