#ifndef eunoe_engine_particle_guard_h
#define eunoe_engine_particle_guard_h

#include <eunoe/contact/pair_list.h>
#include <eunoe/core/parameter_section.h>
#include <eunoe/domain/domain.h>
#include <eunoe/engine/solid_contacts.h>

#include <functional>
#include <optional>
#include <string>

namespace eunoe {

/// What is done about particles that go wrong: entries of `subsection model parameters`.
struct FaultParameters : public ParameterSection
{
  std::string lost_particles = "stop";    ///< stop, remove or ignore
  double largest_overlap = 0.5;           ///< over the radius of the smaller particle; 0: any
  std::string excessive_overlap = "warn"; ///< stop or warn, where an overlap is larger

  void declare(dealii::ParameterHandler &prm) override;
};

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
  std::vector<Fault> fast;     ///< moved farther than the lists allow for
  std::vector<Fault> squeezed; ///< too deep in another particle or in a solid
  /// Largest stiffness over effective mass of a living contact (1/s2), its angular frequency
  /// squared.
  double stiffest = 0.;
};

/// What is done about the faults of all ranks; but for the rows the same on every rank.
struct InspectionResult
{
  bool stops = false;         ///< the run
  bool warns = false;         ///< of particles that are taken out
  std::uint64_t number = 0;   ///< of particles for which that is so
  std::string first;          ///< the one of them with the smallest id, and what is wrong with it
  std::uint64_t squeezed = 0; ///< number of overlaps that are too large, where it goes on
  std::string first_squeezed; ///< likewise, the first time that there are any
  std::vector<std::size_t> lost; ///< rows of this rank's lost particles, which are taken out
};

/// Looks for particles that no correct simulation has, and for contacts that are too stiff.
class ParticleGuard
{
public:
  /// Time steps that the half period of a contact should have at least.
  static constexpr double steps_per_contact = 10.;

  /// @param longest_way that a particle may have gone from its reference up to the last step (m)
  /// @param dt time step (s)
  ParticleGuard(const FaultParameters &parameters, const Domain &domain, const Materials &materials,
                const NormalLaws &laws, double longest_way, double dt);

  void set_longest_way(double way) { longest_way = way; }

  /// What is wrong on this rank.
  Faults inspect(const ParticleArrays &particles, const PairList &pairs,
                 const SolidContacts &solid_contacts, const std::vector<Solid> &solids) const;

  /// What is to be done about it; collective.
  /// @param describe names the particle of a row in words
  InspectionResult judge(const Faults &faults, const ParticleArrays &particles,
                         const std::function<std::string(std::size_t)> &describe);

  /// The most overlaps that were too deep at one time, where that does not stop the run.
  std::uint64_t most_squeezed() const { return most_at_once; }
  /// Goes on from a number that was saved.
  void set_most_squeezed(std::uint64_t n) { most_at_once = n; }

  /// Half period of the stiffest contact of all ranks (s) where it is too short for the time step
  /// and has not been before; collective.
  std::optional<double> newly_too_short(double stiffest);

private:
  void find_overlaps(const ParticleArrays &particles, const PairList &pairs, Faults &faults) const;
  void find_overlaps(const ParticleArrays &particles, const SolidContacts &solid_contacts,
                     const std::vector<Solid> &solids, Faults &faults) const;
  /// Of the faults of all ranks, the one of the particle with the smallest id in words; collective.
  std::string first_of(const std::vector<Fault> &faults, const ParticleArrays &particles,
                       const std::function<std::string(std::size_t)> &describe) const;

  const FaultParameters &parameters;
  const Domain &domain;
  const Materials &materials;
  const std::vector<double> young_modulus; ///< effective, one per kind of pair
  const NormalLaws laws;
  double longest_way;
  const double dt;
  bool found_too_short = false; ///< a half period
  std::uint64_t most_at_once = 0;
};

/// "particle 7 at (0, 1e-3, 0) m with velocity (0, 0, 1) m/s, which touches particle 9 and ..."
std::string describe_particle(const ParticleArrays &particles, std::size_t row,
                              const PairList &pairs, const SolidContacts &solid_contacts,
                              const std::vector<Solid> &solids);

} // namespace eunoe

#endif
