#ifndef eunoe_engine_sparse_contacts_h
#define eunoe_engine_sparse_contacts_h

#include <eunoe/contact/pair_list.h>
#include <eunoe/core/parameter_section.h>
#include <eunoe/engine/halo.h>
#include <eunoe/engine/solid_contacts.h>
#include <eunoe/state/particle_field.h>

#include <optional>

namespace eunoe {

/// Particles at rest sleep, so that their contacts cost nothing: `subsection adaptive sparse
/// contacts`.
struct SparseContactParameters : public ParameterSection
{
  bool enabled = false;
  double rest_speed = 3e-4; ///< up to which a particle is at rest (m/s)
  double rest_time = 2e-3;  ///< for which a particle must have been at rest (s)
  unsigned int frequency = 50;

  void declare(dealii::ParameterHandler &prm) override;
};

/// Disturbances from outside the particles since the last check of the sleepers.
struct Stirring
{
  unsigned long long step = 0;
  std::vector<bool> solid_moves; ///< one per solid
  bool everything = false;       ///< particles came or went, or a load has changed
};

/// Puts particles to sleep and wakes them (adaptive sparse contacts).
///
/// A particle is *restless* while it moves, for some time after, and while a solid that moves is
/// near. Awake are the restless and their neighbours, and the neighbours of these, over the list of
/// pairs that can touch. All others sleep: they have no velocity and no forces, but are
/// obstacles for awake particles; their contacts keep their memory. So a moving particle never
/// meets a sleeper, and a front of waking particles runs ahead of a disturbance.
///
/// All decisions follow from what each particle has done and from lists that do not depend on the
/// distribution over ranks, so they are the same on any number of ranks.
class SparseContacts
{
public:
  /// @param time_step (s)
  SparseContacts(const SparseContactParameters &parameters, double time_step);

  /// Adds what it keeps of every particle, if it is enabled. Called once, before there are
  /// particles.
  void add_fields(ParticleFields &fields);

  /// The field that is not 0 for sleepers; none if nobody ever sleeps.
  const std::optional<FieldHandle> &flag() const { return asleep; }
  bool is_enabled() const { return parameters.enabled; }
  unsigned int frequency() const { return parameters.frequency; }

  /// Determines the sleepers from now on; collective.
  void update(ParticleArrays &particles, const PairList &pairs, const SolidContacts &solids,
              Halo &halo, const Stirring &stirring) const;

  /// Keeps awake the owned particles of all pairs with a flag.
  /// @param flags one per particle, ghosts too
  void stir_neighbours(ParticleArrays &particles, const PairList &pairs,
                       const std::vector<std::uint8_t> &flags, unsigned long long step) const;

  /// Restores the sleepers from saved fields; collective.
  void recall(ParticleArrays &particles, Halo &halo) const;

private:
  std::vector<std::uint8_t> find_restless(ParticleArrays &particles, const SolidContacts &solids,
                                          const Stirring &stirring) const;

  const SparseContactParameters &parameters;
  std::optional<FieldHandle> asleep;
  std::optional<FieldHandle> last_moved; ///< step at which the particle was last not at rest
  const double rest_steps;
};

} // namespace eunoe

#endif
