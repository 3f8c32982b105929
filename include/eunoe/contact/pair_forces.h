#ifndef eunoe_contact_pair_forces_h
#define eunoe_contact_pair_forces_h

#include <eunoe/contact/contact_force.h>
#include <eunoe/contact/contact_model.h>
#include <eunoe/contact/pair_list.h>
#include <eunoe/core/periodic_box.h>
#include <eunoe/state/particle_arrays.h>

#include <memory>

namespace eunoe {

struct ParticleBlock;

/// The forces and torques of all particle-particle contacts.
class PairForces
{
public:
  PairForces(const ContactModel &model, const PeriodicBox &box);
  ~PairForces();

  /// Adds to the force and torque of every particle in @p particles (those of ghosts are partial
  /// sums without meaning) and advances the memory of the contacts by @p dt.
  void add(ParticleArrays &particles, PairList &pairs, double dt);

  /// Gives the present forces of the contacts to @p sink, in the order of the list. The memory of
  /// contacts does not change; a contact that has not begun has none.
  /// @param places of the pairs that are asked for, ascending; null: all
  void evaluate(const ParticleArrays &particles, const PairList &pairs,
                const std::vector<std::int32_t> *places, const ContactForceSink &sink) const;

private:
  class Run;

  void list_near(ParticleArrays &particles, PairList &pairs, double dt) const;
  /// All near pairs go through the laws, which work on their memory where it is.
  void add_of_all(ParticleArrays &particles, PairList &pairs, double dt) const;
  /// Only those within reach do, with copies of their memory: for lists in which these are few.
  void add_of_some(ParticleArrays &particles, PairList &pairs, double dt) const;

  const ContactModel &model;
  const PeriodicBox box;
  std::unique_ptr<ParticleBlock[]> blocks; ///< two in turn
};

} // namespace eunoe

#endif
