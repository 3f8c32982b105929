#ifndef eunoe_engine_sparse_contacts_h
#define eunoe_engine_sparse_contacts_h

#include <eunoe/contact/pair_list.h>
#include <eunoe/core/parameter_section.h>
#include <eunoe/core/periodic_box.h>
#include <eunoe/engine/halo.h>
#include <eunoe/engine/solid_contacts.h>
#include <eunoe/state/particle_field.h>

#include <cmath>
#include <optional>

namespace eunoe {

/// Particles at rest sleep, so that their contacts cost nothing: `subsection adaptive sparse
/// contacts`.
struct SparseContactParameters : public ParameterSection
{
  bool enabled = false;
  std::optional<double> rest_speed; ///< up to which a particle is at rest (m/s); none: `auto`
  std::optional<double> rest_time;  ///< for which a particle must have been at rest (s), likewise
  double rest_displacement = 1e-3;  ///< up to which a particle has not moved, in its diameters
  unsigned int frequency = 50;

  void declare(dealii::ParameterHandler &prm) override;
  /// Automatic values come from the fall of a particle.
  void check_with(const Vec3 &gravity, const ParameterCheck &check) const;
};

/// When particles count as at rest. Creep has a speed that is no larger than that of a particle at
/// rest that still vibrates, but a displacement that grows; so both are limited.
class RestCriterion
{
public:
  /// @param gravity its magnitude (m/s2), on which the automatic values depend
  RestCriterion(const SparseContactParameters &parameters, double gravity, double time_step)
      : parameters(parameters), gravity(gravity), time_step(time_step)
  {
  }

  /// Largest distance of a particle at rest from where its rest began (m).
  double displacement(double radius) const { return 2. * radius * parameters.rest_displacement; }
  /// Square of its largest speed (m2/s2); `auto`: that of a fall through the displacement.
  double speed_square(double radius) const
  {
    return parameters.rest_speed ? *parameters.rest_speed * *parameters.rest_speed
                                 : 2. * gravity * displacement(radius);
  }
  /// Steps of rest before sleep; `auto`: the time of a fall through half of the diameter.
  double steps(double radius) const
  {
    const double time =
        parameters.rest_time ? *parameters.rest_time : std::sqrt(2. * radius / gravity);
    return time / time_step;
  }

private:
  const SparseContactParameters &parameters;
  const double gravity, time_step;
};

/// When the sleepers are checked, and disturbances from outside the particles since the last check.
struct Stirring
{
  unsigned long long step = 0;
  std::vector<bool> solid_moves; ///< one per solid
  bool everything = false;       ///< a load has changed, or a phase begins
  bool forces_follow = false;    ///< in this step; otherwise it is between two steps
};

/// Puts particles to sleep and wakes them (adaptive sparse contacts).
///
/// A particle is *restless* while it moves, for some time after, and while a solid that moves is
/// near. It moves if it is fast, or has come too far from the place where its rest began. Awake are
/// the restless and their neighbours, and the neighbours of these, over the list of pairs that can
/// touch. All others sleep: they have no velocity and no forces, but are obstacles for awake
/// particles; their contacts keep their memory. So a moving particle never meets a sleeper, and a
/// front of waking particles runs ahead of a disturbance.
///
/// All decisions follow from what each particle has done and from lists that do not depend on the
/// distribution over ranks, so they are the same on any number of ranks.
class SparseContacts
{
public:
  /// @param gravity magnitude (m/s2)
  /// @param time_step (s)
  SparseContacts(const SparseContactParameters &parameters, double gravity, double time_step);

  /// Adds what it keeps of every particle, if it is enabled. Called once, before there are
  /// particles.
  void add_fields(ParticleFields &fields);

  /// The field that is not 0 for sleepers; none if nobody ever sleeps.
  const std::optional<FieldHandle> &flag() const { return asleep; }
  bool is_enabled() const { return parameters.enabled; }
  unsigned int frequency() const { return parameters.frequency; }

  /// Determines the sleepers from now on; collective.
  void update(ParticleArrays &particles, const PairList &pairs, const SolidContacts &solids,
              Halo &halo, const PeriodicBox &periods, const Stirring &stirring) const;

  /// Keeps awake the owned particles of all pairs with a flag.
  /// @param flags one per particle, ghosts too
  void stir_neighbours(ParticleArrays &particles, const PairList &pairs,
                       const std::vector<std::uint8_t> &flags, unsigned long long step) const;

  /// Restores the sleepers from saved fields; collective.
  void recall(ParticleArrays &particles, Halo &halo) const;

private:
  std::vector<std::uint8_t> find_restless(ParticleArrays &particles, const SolidContacts &solids,
                                          const PeriodicBox &periods,
                                          const Stirring &stirring) const;

  const SparseContactParameters &parameters;
  const RestCriterion rest;
  std::optional<FieldHandle> asleep;
  std::optional<FieldHandle> last_moved; ///< step at which the particle was last not at rest
  std::optional<FieldHandle> rest_place; ///< where it was then (m)
};

} // namespace eunoe

#endif
