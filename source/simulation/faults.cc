// What a simulation does when particles go wrong.

#include <eunoe/simulation/simulation.h>

#include <limits>

namespace eunoe {

std::vector<std::size_t> Simulation::inspect()
{
  // Two bodies must not come closer by more than the skin without a search; half of it is the way
  // of each.
  const Faults faults = system.inspect(guard, solids, 0.5 * skin, parameters.control.time_step);
  const bool stops_for_lost = parameters.model.lost_particles == "stop";
  std::vector<Fault> grave = faults.squeezed;
  if (stops_for_lost)
    grave.insert(grave.end(), faults.lost.begin(), faults.lost.end());

  std::uint64_t numbers[2] = {grave.size(), faults.lost.size()};
  MPI_Allreduce(MPI_IN_PLACE, numbers, 2, MPI_UINT64_T, MPI_SUM, comm);
  compare_time_step(faults.stiffest);
  if (numbers[0] + numbers[1] == 0)
    return {};

  // The one with the smallest id is named, whichever rank it is on.
  const std::vector<Fault> &list = numbers[0] > 0 ? grave : faults.lost;
  ParticleId mine = std::numeric_limits<ParticleId>::max();
  std::string text;
  for (const Fault &fault : list) {
    const ParticleId id = system.particles.id[fault.row];
    if (id < mine) {
      mine = id;
      text = system.describe(fault.row, solids) + " " + fault.what;
    }
  }
  ParticleId smallest = mine;
  MPI_Allreduce(MPI_IN_PLACE, &smallest, 1, MPI_UINT32_T, MPI_MIN, comm);
  int first = std::numeric_limits<int>::max();
  if (mine == smallest)
    MPI_Comm_rank(comm, &first);
  MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, comm);
  int length = static_cast<int>(text.size());
  MPI_Bcast(&length, 1, MPI_INT, first, comm);
  text.resize(length);
  MPI_Bcast(text.data(), length, MPI_CHAR, first, comm);

  if (numbers[0] > 0)
    stop_for(text, numbers[0]);
  if (parameters.model.lost_particles == "remove")
    log.warning("At t = " + format(present_time) + " s, " + std::to_string(numbers[1]) +
                " lost particle(s) are taken out: " + text);
  std::vector<std::size_t> rows;
  for (const Fault &fault : faults.lost)
    rows.push_back(fault.row);
  return rows;
}

void Simulation::stop_for(const std::string &first, const std::uint64_t number)
{
  std::string place;
  if (output.is_open()) {
    const std::string file = output.file(parameters.restart.filename + "_fault.checkpoint");
    place = " The state is in " + file + ".";
    try {
      dump(file);
    } catch (const UserError &error) {
      place = std::string(" ") + error.what();
    }
  }
  throw UserError(
      "At t = " + format(present_time) + " s (step " + std::to_string(step) + "), " + first +
      (number > 1 ? " " + std::to_string(number - 1) + " more have gone wrong." : "") +
      " Check the time step, the solids and the insertion; doc/faults.md tells what may "
      "be behind it." +
      place);
}

} // namespace eunoe
