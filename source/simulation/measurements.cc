// What observables, processes and discovery read of a run.

#include <eunoe/simulation/simulation.h>

namespace eunoe {

std::vector<SolidLoad> Simulation::global_solid_loads() const
{
  return solids.global_loads(communicator());
}

std::vector<ContactForce> Simulation::contact_forces()
{
  complete_step();
  // The velocities of ghosts are behind those of owned particles, which are of the present time.
  system.update_ghosts();
  return system.contact_forces(solids.list(), clock.time());
}

void Simulation::write_pictures(PictureSeries &series)
{
  complete_step();
  const Timers::Scope scope(progress.timers, Section::output);
  series.write(clock.time(), system.particles, system.fields(), outputs.fields(*this));
}

std::vector<Measurement> Simulation::measurements() const
{
  std::vector<Measurement> all;
  if (process)
    all = process->measurements();
  const std::vector<Measurement> more = outputs.measurements();
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

std::vector<ObservableDescription> Simulation::described_observables() const
{
  std::vector<ObservableDescription> all;
  if (process)
    all = parameters.process()->observables();
  const std::vector<ObservableDescription> more = outputs.descriptions();
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

void Simulation::write_measurements()
{
  const std::vector<Measurement> all = measurements();
  if (all.empty())
    return;
  outputs.folder.write("measurements.csv", table_of(all, described_observables()));
}

} // namespace eunoe
