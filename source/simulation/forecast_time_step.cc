// Whether the time step is small enough for the contacts, and the solids slow enough for it.

#include "judgements.h"

#include <algorithm>
#include <cmath>

namespace eunoe {

namespace {

/// Diameter (m) from which millimetres may have been taken for metres.
constexpr double suspicious_diameter = 0.2;
/// Share of the Rayleigh time up to which contacts keep their energy.
constexpr double largest_rayleigh_share = 0.25;
constexpr double steps_per_contact = ParticleGuard::steps_per_contact;
/// Share of the smallest radius that a solid may go in one step, or it jumps into particles.
constexpr double largest_jump = 0.1;
/// Steps between two searches below which they cost more than the forces.
constexpr double fewest_steps_between_searches = 20.;

const std::string time_step_entry = "subsection 'simulation control' / entry 'time step':";

/// The half period of a contact in words.
std::string share_of_contact(const double steps)
{
  return steps >= 1. ? "1/" + format(std::floor(steps)) + " of the stiffest contact's time"
                     : format(1. / steps) + " times the stiffest contact's time";
}

std::string describe_diameters(const double smallest, const double largest)
{
  const std::string from = format(1e6 * smallest), to = format(1e6 * largest);
  return (from == to ? "diameter " : "diameters " + from + " to ") + to + " um";
}

} // namespace

void judge_time_step(const Parameters &parameters, const std::vector<DiameterRange> &diameters,
                     Forecast &forecast)
{
  const double dt = parameters.control.time_step;
  for (const auto &[t, smallest, largest] : diameters) {
    const ParticleType &type = parameters.physics.types[t];
    const double rayleigh =
        PhysicalProperties::rayleigh_time(0.5 * smallest, type.density, type.material);
    const double contact = parameters.physics.shortest_contact_time(
        type, 0.5 * smallest, parameters.contacts.normal_laws());
    forecast.facts.push_back("Particle type " + std::to_string(t) + ": " +
                             describe_diameters(smallest, largest) + "; the time step of " +
                             format(dt) + " s is " + format(std::round(1e3 * dt / rayleigh) / 10.) +
                             " % of the Rayleigh time and " + share_of_contact(contact / dt));
    if (smallest > suspicious_diameter)
      forecast.problems.warn("subsection 'lagrangian physical properties' / subsection 'particle "
                             "type " +
                                 std::to_string(t) + "':",
                             "the particles have diameters of " + format(smallest) + " m and more.",
                             "All lengths are in metres: write 1e-3 for a millimetre.");
    // The sizes of the type, from which it follows, are not those of particles that are given.
    if (!parameters.control.given_time_step &&
        dt > 1.001 * parameters.control.rayleigh_share * rayleigh)
      forecast.problems.add(time_step_entry,
                            "'auto' goes by the sizes of the particle type, and smaller particles, "
                            "of " +
                                format(1e6 * smallest) + " um, are inserted.",
                            "Give the type their sizes, or give a number.");
    else if (dt > largest_rayleigh_share * rayleigh)
      forecast.problems.warn(
          time_step_entry,
          "the time step exceeds 25 % of the Rayleigh time of particle type " + std::to_string(t) +
              "; contacts may gain energy.",
          "At most " +
              format(std::min(largest_rayleigh_share * rayleigh, contact / steps_per_contact)) +
              " s is advised.");
    else if (dt > contact / steps_per_contact)
      forecast.problems.warn(time_step_entry,
                             "the stiffest contact of particle type " + std::to_string(t) +
                                 " takes " + format(contact) +
                                 " s, less than ten time steps; it may gain energy.",
                             "At most " + format(contact / steps_per_contact) + " s is advised.");
  }
}

void judge_searches(const double fastest, const double allowed_displacement, const double time_step,
                    Forecast &forecast)
{
  if (!(fastest > 0.))
    return;
  // Particles may come towards the solid as fast as it goes.
  const double steps = std::floor(allowed_displacement / (2. * fastest * time_step));
  forecast.facts.push_back("The fastest solid moves at " + format(fastest) +
                           " m/s, for which contacts are searched every " +
                           format(std::max(1., steps)) + " steps");
  if (steps < fewest_steps_between_searches)
    forecast.problems.warn("subsection 'model parameters' / subsection 'contact detection' / "
                           "entry 'neighborhood threshold':",
                           "searches for contacts will take much of the time.",
                           "A larger 'neighborhood threshold', a smaller time step or a slower "
                           "solid helps.");
}

void judge_jump(const double speed, const Parameters &parameters, const double smallest_radius,
                const std::string &when, const std::string &mend, Problems &problems)
{
  const double step = speed * parameters.control.time_step;
  if (step > largest_jump * smallest_radius)
    problems.add(time_step_entry,
                 "a solid moves by " + format(step) + " m in a time step" + when +
                     ", more than a tenth of the " + format(smallest_radius) +
                     " m of the smallest particle's radius, so that it would jump into particles.",
                 mend.empty() ? "Lower the time step or the solid's velocity." : mend);
}

} // namespace eunoe
