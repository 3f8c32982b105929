#ifndef eunoe_contact_pair_forces_h
#define eunoe_contact_pair_forces_h

#include <eunoe/contact/contact_force.h>
#include <eunoe/contact/contact_model.h>
#include <eunoe/contact/pair_list.h>
#include <eunoe/core/periodic_box.h>
#include <eunoe/state/particle_arrays.h>

#include <memory>

namespace eunoe {

/// Adds the forces and torques of all particle-particle contacts.
class PairForces
{
public:
  PairForces(const ContactModel &model, const PeriodicBox &box);

  /// Adds to the force and torque of every particle in @p particles (those of ghosts are partial
  /// sums without meaning) and advances the memory of the contacts by @p dt.
  void add(ParticleArrays &particles, PairList &pairs, double dt);

  /// From now on `add` appends every contact to @p list; null: no longer.
  void record_to(std::vector<ContactForce> *list) { recorded = list; }

private:
  void run_block(ParticleArrays &particles, PairList &pairs, const std::int32_t *active,
                 unsigned int n, double dt);

  const ContactModel &model;
  const PeriodicBox box;
  std::unique_ptr<PairBlock> block;
  std::vector<std::int32_t> active, ended;
  std::vector<ContactForce> *recorded = nullptr;
};

} // namespace eunoe

#endif
