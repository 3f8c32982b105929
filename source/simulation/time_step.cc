// Whether the time step is small enough for the contacts, and the solids slow enough for it.

#include <eunoe/simulation/simulation.h>

#include <algorithm>
#include <cmath>

namespace eunoe {

namespace {

/// Share of the Rayleigh time up to which contacts keep their energy.
constexpr double largest_rayleigh_share = 0.25;
/// Time steps that the half period of a contact should have at least.
constexpr double steps_per_contact = 10.;
/// Share of the smallest radius that a solid may go in one step, or it jumps into particles.
constexpr double largest_jump = 0.1;
/// Steps between two searches below which they cost more than the forces.
constexpr double fewest_steps_between_searches = 20.;

} // namespace

void Simulation::judge_time_step()
{
  const double dt = parameters.control.time_step;
  for (std::size_t t = 0; t < parameters.physics.types.size(); ++t) {
    const ParticleType &type = parameters.physics.types[t];
    const auto sizes = type.sizes.make();
    const double rayleigh =
        PhysicalProperties::rayleigh_time(0.5 * sizes->smallest(), type.density, type.material);
    const double contact = parameters.physics.shortest_contact_time(type);
    log.line("Particle type " + std::to_string(t) + ": diameters " +
             format(1e6 * sizes->smallest()) + " to " + format(1e6 * sizes->largest()) +
             " um; the time step of " + format(dt) + " s is " +
             format(std::round(1e3 * dt / rayleigh) / 10.) + " % of the Rayleigh time and 1/" +
             format(std::floor(contact / dt)) + " of the stiffest contact's time");
    if (dt > largest_rayleigh_share * rayleigh)
      log.warning("the time step exceeds 25 % of the Rayleigh time of particle type " +
                  std::to_string(t) + "; contacts may gain energy. At most " +
                  format(largest_rayleigh_share * rayleigh) + " s is advised.");
    else if (dt > contact / steps_per_contact)
      log.warning("the stiffest contact of particle type " + std::to_string(t) + " takes " +
                  format(contact) + " s, less than ten time steps; it may gain energy. At most " +
                  format(contact / steps_per_contact) + " s is advised.");
  }
  const double fastest = fastest_solid();
  if (fastest > 0.) {
    // Particles may come towards the solid as fast as it goes.
    const double steps = std::floor(allowed_displacement / (2. * fastest * dt));
    log.line("The fastest solid moves at " + format(fastest) +
             " m/s, for which contacts are searched every " + format(std::max(1., steps)) +
             " steps");
    if (steps < fewest_steps_between_searches)
      log.warning("searches for contacts will take much of the time. A larger 'neighborhood "
                  "threshold', a smaller time step or a slower solid helps.");
  }
}

double Simulation::fastest_solid() const
{
  const double dt = parameters.control.time_step;
  double fastest = parameters.process() != nullptr ? parameters.process()->fastest_solid() : 0.;
  for (const Solid &solid : solids)
    fastest =
        std::max(fastest, displacement(solid, solid.motion->at(0.), solid.motion->at(dt)) / dt);
  return fastest;
}

void Simulation::check_speeds(Problems &problems) const
{
  const double step = fastest_solid() * parameters.control.time_step;
  const double radius = 0.5 * parameters.physics.smallest_diameter();
  if (step > largest_jump * radius)
    problems.add("subsection 'simulation control' / entry 'time step':",
                 "a solid moves by " + format(step) +
                     " m in a time step, more than a tenth of the " + format(radius) +
                     " m of the smallest particle's radius, so that it would jump into particles.",
                 "Lower the time step or the solid's velocity.");
}

void Simulation::compare_time_step(double stiffest)
{
  if (warned_of_stiffness)
    return;
  MPI_Allreduce(MPI_IN_PLACE, &stiffest, 1, MPI_DOUBLE, MPI_MAX, comm);
  const double dt = parameters.control.time_step;
  const double contact_time =
      stiffest > 0. ? M_PI / std::sqrt(stiffest) : std::numeric_limits<double>::infinity();
  if (dt <= contact_time / steps_per_contact)
    return;
  log.warning("at t = " + format(present_time) + " s the stiffest contact takes " +
              format(contact_time) + " s, no more than " + format(contact_time / dt) +
              " time steps, and may gain energy. At most " +
              format(contact_time / steps_per_contact) + " s is advised.");
  warned_of_stiffness = true;
}

} // namespace eunoe
