// What a run has measured, as observables and discovery ask for it.

#include <eunoe/simulation/simulation.h>

#include <cstdio>
#include <map>

namespace eunoe {

std::vector<SolidLoad> Simulation::global_solid_loads() const
{
  std::vector<SolidLoad> sums = solid_loads;
  for (SolidLoad &load : sums)
    for (unsigned int d = 0; d < 3; ++d) {
      load.force[d].reduce(comm);
      load.torque[d].reduce(comm);
    }
  return sums;
}

std::vector<ContactForce> Simulation::contact_forces()
{
  complete_step();
  // The velocities of ghosts are behind those of owned particles, which are of the present time.
  system.update_ghosts();
  return system.contact_forces(solids, present_time);
}

std::vector<Measurement> Simulation::measurements() const
{
  std::vector<Measurement> all;
  const auto append = [&all](const std::vector<Measurement> &more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  if (const Process *const process = parameters.process())
    append(process->measurements());
  for (const auto &[name, observable] : observable_list)
    append(observable->measurements());
  return all;
}

std::vector<ObservableDescription> Simulation::described_observables() const
{
  std::vector<ObservableDescription> all;
  const auto append = [&all](const std::vector<ObservableDescription> &more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  if (const Process *const process = parameters.process())
    append(process->observables());
  for (const auto &[name, observable] : observable_list)
    append(observable->descriptions());
  return all;
}

void Simulation::write_measurements()
{
  const std::vector<Measurement> all = measurements();
  if (all.empty())
    return;
  std::map<std::string, std::string> units;
  for (const ObservableDescription &description : described_observables())
    units[description.name] = description.unit;
  std::string text = "observable,index,value,unit\n";
  for (const Measurement &m : all) {
    char value[32];
    std::snprintf(value, sizeof value, "%.17g", m.value);
    text += m.observable + "," + std::to_string(m.index) + "," + value + "," + units[m.observable] +
            "\n";
  }
  output.write("measurements.csv", text);
}

} // namespace eunoe
