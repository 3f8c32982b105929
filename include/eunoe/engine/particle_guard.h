#ifndef eunoe_engine_particle_guard_h
#define eunoe_engine_particle_guard_h

#include <eunoe/contact/pair_list.h>
#include <eunoe/domain/domain.h>
#include <eunoe/engine/solid_contacts.h>

#include <string>

namespace eunoe {

/// A particle of which something is wrong.
struct Fault
{
  std::size_t row;  ///< of an owned particle
  std::string what; ///< completes the sentence "particle 7 at ... "
};

/// Particles with something wrong on this rank.
struct Faults
{
  std::vector<Fault> lost;     ///< not a number, or outside the mesh and beyond no outlet
  std::vector<Fault> squeezed; ///< too deep in another particle or in a solid, or too fast
  /// Largest stiffness over effective mass of a living contact (1/s2), its angular frequency
  /// squared.
  double stiffest = 0.;
};

/// Looks for particles that no correct simulation has.
class ParticleGuard
{
public:
  /// @param largest_overlap over the radius of the smaller particle; 0: any
  ParticleGuard(const Domain &domain, const Materials &materials, double largest_overlap);

  /// @param longest_way that a particle may have gone between the last search and the last step (m)
  /// @param dt time step (s)
  Faults inspect(const ParticleArrays &particles, const PairList &pairs,
                 const SolidContacts &solid_contacts, const std::vector<Solid> &solids,
                 double longest_way, double dt) const;

private:
  void find_overlaps(const ParticleArrays &particles, const PairList &pairs, Faults &faults) const;
  void find_overlaps(const ParticleArrays &particles, const SolidContacts &solid_contacts,
                     const std::vector<Solid> &solids, Faults &faults) const;

  const Domain &domain;
  const Materials &materials;
  const std::vector<double> young_modulus; ///< effective, one a kind of pair
  const double largest_overlap;
};

/// "particle 7 at (0, 1e-3, 0) m with velocity (0, 0, 1) m/s, which touches particle 9 and ..."
std::string describe_particle(const ParticleArrays &particles, std::size_t row,
                              const PairList &pairs, const SolidContacts &solid_contacts,
                              const std::vector<Solid> &solids);

} // namespace eunoe

#endif
