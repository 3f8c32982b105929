// What a simulation does when particles go wrong.

#include <eunoe/simulation/simulation.h>

namespace eunoe {

std::vector<std::size_t> Simulation::inspect()
{
  const Faults faults = system.inspect(guard, solids.list());
  const auto describe = [this](std::size_t row) { return system.describe(row, solids.list()); };
  const InspectionResult result = guard.judge(faults, system.particles, describe);
  if (const auto half_period = guard.newly_too_short(faults.stiffest))
    get_log().warning("at t = " + format(time()) + " s the stiffest contact takes " +
                      format(*half_period) + " s, no more than " +
                      format(*half_period / time_step()) +
                      " time steps, and may gain energy. At most " +
                      format(*half_period / ParticleGuard::steps_per_contact) + " s is advised.");
  if (!result.first_squeezed.empty())
    get_log().warning("At t = " + format(time()) + " s, " + result.first_squeezed +
                      " The run goes on, and the summary counts such particles; with 'excessive "
                      "overlap = stop' it would stop.");
  if (result.stops)
    stop_for(result);
  if (result.warns)
    get_log().warning("At t = " + format(time()) + " s, " + std::to_string(result.number) +
                      " lost particle(s) are taken out: " + result.first);
  return result.lost;
}

void Simulation::stop_for(const InspectionResult &result)
{
  std::string place;
  if (outputs.folder.is_open()) {
    const std::string file = outputs.folder.file(checkpoints.fault_file());
    place = " The state is in " + file + ".";
    try {
      dump(file);
    } catch (const UserError &error) {
      place = std::string(" ") + error.what();
    }
  }
  throw UserError("At t = " + format(time()) + " s (step " + std::to_string(step_number()) + "), " +
                  result.first +
                  (result.number > 1
                       ? " " + std::to_string(result.number - 1) + " more have gone wrong."
                       : "") +
                  " Check the time step, the solids and the insertion; doc/faults.md tells what "
                  "may be behind it." +
                  place);
}

} // namespace eunoe
