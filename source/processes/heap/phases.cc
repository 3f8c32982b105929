// The filling of the tube, its lifting, and when powder is at rest.

#include <eunoe/processes/heap/heap.h>
#include <eunoe/processes/loose_powder.h>

#include <algorithm>

namespace eunoe::heap {

void Heap::fill(Simulation &simulation)
{
  simulation.insert_and_remove(
      loose_powder(simulation, 0, apparatus.n_particles, {0., -p.insertion_speed, 0.},
                   [&](std::size_t k, ParticleId id) { return apparatus.loose_place(k, id); }),
      {});
}

bool Heap::is_at_rest(Simulation &simulation)
{
  if (simulation.step_number() % p.rest_check_frequency != 0)
    return false;
  const ParticleArrays &particles = simulation.complete_step();
  const double tube_height = height_of_tube(simulation);
  // Spin does not count: the contact laws have no torque against spin about a contact's normal. Nor
  // does what swings at the tube, once it is lifted.
  unsigned long long moving = 0, all = 0;
  for (std::size_t row = 0; row < particles.n_owned; ++row) {
    const double radius = particles.radius(row);
    if (phase == Phase::resting &&
        apparatus.clings_to_tube(particles.position[row].y, radius, tube_height))
      continue;
    ++all;
    if (0.5 * norm_square(particles.velocity[row].vec()) >
        p.rest_energy_share * apparatus.gravity * 2. * radius)
      ++moving;
  }
  MPI_Allreduce(MPI_IN_PLACE, &moving, 1, MPI_UNSIGNED_LONG_LONG, MPI_SUM,
                simulation.communicator());
  MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_UNSIGNED_LONG_LONG, MPI_SUM, simulation.communicator());
  const double now = simulation.time();
  if (static_cast<double>(moving) > p.moving_share * static_cast<double>(all))
    calm_since = -1.;
  else if (calm_since < 0.)
    calm_since = now;
  if (calm_since >= 0. && now - calm_since >= p.rest_duration)
    return true;
  if (now - phase_start < p.longest_wait)
    return false;
  simulation.get_log().warning("after the longest wait of " + format(p.longest_wait) + " s, " +
                               std::to_string(moving) + " of " + std::to_string(all) +
                               " particles still move; going on.");
  return true;
}

bool Heap::is_to_be_measured(Simulation &simulation)
{
  if (p.measurement_delay > 0.)
    return simulation.time() - phase_start >= p.measurement_delay;
  return is_at_rest(simulation);
}

void Heap::begin_lifting(Simulation &simulation)
{
  const ParticleArrays &particles = simulation.complete_step();
  double top = 0.;
  for (std::size_t row = 0; row < particles.n_owned; ++row)
    top = std::max(top, particles.position[row].y + particles.radius(row));
  MPI_Allreduce(MPI_IN_PLACE, &top, 1, MPI_DOUBLE, MPI_MAX, simulation.communicator());
  phase = Phase::lifting;
  phase_start = lift_start = simulation.time();
  lift_way = top + apparatus.clearance() - p.gap;
  apparatus.tube->begin(lift_start, lift_way);
  simulation.renew_solids();
  simulation.get_log().line("The powder is at rest in the tube after " + format(lift_start) +
                            " s, " + format(top) + " m high; the tube rises by " +
                            format(lift_way) + " m");
}

void Heap::finish(Simulation &simulation)
{
  results = measure(simulation, p, apparatus, height_of_tube(simulation));
  results.keys["heap_lifted_time"] = phase_start;
  results.keys["heap_rest_time"] = simulation.time();
  phase = Phase::done;
  simulation.get_log().line(
      (p.measurement_delay > 0. ? "The heap is measured after " : "The heap is at rest after ") +
      format(simulation.time()) + " s: base angle " + format(results.keys["heap_base_angle"]) +
      " degrees (standard deviation over the views " +
      format(results.keys["heap_base_angle_spread"]) + "), " +
      std::to_string(results.keys["heap_particles_on_disc"].get<std::uint64_t>()) +
      " particles on the disc");
  if (p.picture) {
    const std::string name = simulation.get_parameters().control.output_name + "_heap";
    simulation.write_pictures(*simulation.output_folder().pictures(name));
    simulation.output_folder()
        .pictures(name + "_solids")
        ->write(simulation.time(), simulation.get_solids());
  }
}

} // namespace eunoe::heap
