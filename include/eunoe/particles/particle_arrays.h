#ifndef eunoe_particles_particle_arrays_h
#define eunoe_particles_particle_arrays_h

#include <eunoe/core/vec3.h>

#include <cstdint>
#include <vector>

namespace eunoe {

/// Identity of a particle, unique over the whole run and never used again.
using ParticleId = std::uint32_t;

/// The hot state of the particles that a rank computes with: those that it owns, then copies of
/// those that its neighbours own (ghosts), each part ordered by (contact-grid cell, id). Rebuilt
/// from the particle store at every contact search. SI units.
struct ParticleArrays
{
  std::size_t n_owned = 0, n_ghosts = 0;

  std::vector<Quad> position; ///< x, y, z and radius
  std::vector<Quad> velocity; ///< velocity and mass
  std::vector<Quad> spin;     ///< angular velocity and moment of inertia
  std::vector<Quad> force;    ///< force; w unused
  std::vector<Quad> torque;   ///< torque; w unused
  std::vector<ParticleId> id;
  std::vector<std::int32_t> type; ///< particle type, which is its material

  /// @name Owned particles only
  ///@{
  std::vector<Vec3> reference; ///< position at the last search
  /// Further data that processes attach to particles (layer tag, ...), `[component][particle]`.
  std::vector<std::vector<double>> extra;
  ///@}

  std::size_t size() const { return n_owned + n_ghosts; }

  void resize(std::size_t owned, std::size_t ghosts, unsigned int n_extra);
};

} // namespace eunoe

#endif
