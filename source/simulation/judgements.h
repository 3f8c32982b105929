#ifndef eunoe_source_simulation_judgements_h
#define eunoe_source_simulation_judgements_h

// The parts of Simulation::foresee: each adds to a forecast what it knows and what it doubts.

#include <eunoe/simulation/forecast.h>
#include <eunoe/simulation/simulation.h>

namespace eunoe {

/// Diameters of a particle type (m).
struct DiameterRange
{
  std::size_t type;
  double smallest, largest;
};

/// The time step against what contacts need.
/// @param diameters of the types that have particles
void judge_time_step(const Parameters &parameters, const std::vector<DiameterRange> &diameters,
                     Forecast &forecast);

/// The speed of the fastest solid (m/s) against the skin.
/// @param allowed_displacement of two bodies towards each other between two searches (m)
void judge_searches(double fastest, double allowed_displacement, double time_step,
                    Forecast &forecast);

/// Notes that a solid would jump into particles if it goes too far in a time step.
/// @param speed of the solid (m/s)
/// @param smallest_radius of a particle (m)
/// @param when empty, or " at t = 1 s"
/// @param mend what to do about it; empty: about the speed
void judge_jump(double speed, const Parameters &parameters, double smallest_radius,
                const std::string &when, const std::string &mend, Problems &problems);

/// Size, place and path of the solids of the input against the mesh.
/// @param diameters of all particles
/// @return the largest speed that one of them reaches (m/s)
double judge_solids(const Parameters &parameters, const std::vector<Solid> &solids,
                    const Domain &domain, const DiameterRange &diameters, Forecast &forecast);

/// What is inserted: whether there is anything, where it comes to lie, whether it all comes.
/// @param events particles of the first events, this rank's share
void judge_insertion(const Parameters &parameters, const Insertion &insertion,
                     const std::vector<std::vector<NewParticle>> &events,
                     const std::vector<Solid> &solids, const Domain &domain, Forecast &forecast);

/// Number of events of insertion in a run.
std::size_t number_of_events(const Parameters &parameters);

/// Memory against what the machine has, and the number of steps.
void judge_resources(const Parameters &parameters, const RunEstimate &estimate, MPI_Comm comm,
                     Forecast &forecast);

/// Pictures and checkpoints against the room on the disk, and the folder of the results.
/// @param n_extra doubles that are attached to every particle
void judge_output(const Parameters &parameters, const RunEstimate &estimate, unsigned int n_extra,
                  MPI_Comm comm, Forecast &forecast);

/// Corners of a box for the user: "(0, 0, 0) to (1, 1, 1) m".
std::string describe(const Box &box);

} // namespace eunoe

#endif
