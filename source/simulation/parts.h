#ifndef eunoe_source_simulation_parts_h
#define eunoe_source_simulation_parts_h

// What the constructor of Simulation makes of the input.

#include <eunoe/simulation/simulation.h>

namespace eunoe {

/// Null for a general case.
std::unique_ptr<Process> make_process(const Parameters &parameters);

/// Null for a process, which makes its own.
std::unique_ptr<Insertion> make_insertion(const Parameters &parameters, MPI_Comm comm, Log &log);

/// The mesh, with a word before it if its making takes long.
Background background_of(const Parameters &parameters, Log &log);

/// Of the particles to come (m).
double largest_diameter(const Parameters &parameters, const Inserter &inserter);

/// Skins of contact searches (m).
struct Skins
{
  double wanted;  ///< by the input
  double least;   ///< that a run can do with
  double contact; ///< distance of two centres up to which particles act on each other

  Skins(const Parameters &parameters, const Inserter &inserter);

  /// The skin in a domain: smaller than wanted where a period is so short that a pair would be
  /// found on both sides.
  double in(const PeriodicBox &box) const { return limited(wanted, box); }
  /// Likewise of another one that is wanted (m).
  double limited(double skin, const PeriodicBox &box) const;
};

/// The skin of a run (m), with which it begins.
double skin_of(const Parameters &parameters, const Inserter &inserter, const Domain &domain);

/// None where the input gives the skin.
std::optional<SkinTuner> skin_tuner_of(const Parameters &parameters, const Inserter &inserter,
                                       const Domain &domain);

ParticlePhysics physics_of(const Parameters &parameters, const Inserter &inserter, Process *process,
                           Sleeper &sleeper);

} // namespace eunoe

#endif
