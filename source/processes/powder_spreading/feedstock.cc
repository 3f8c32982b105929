// How the feedstock comes into the reservoir and to rest.

#include <eunoe/processes/loose_powder.h>
#include <eunoe/processes/powder_spreading/powder_spreading.h>

#include <algorithm>
#include <cmath>

namespace eunoe::spreading {

namespace {

/// Steps between two looks at whether the bed has come to rest.
constexpr unsigned long long settling_check = 500;
/// Loose particles inserted over those that the settled bed is expected to take.
constexpr double loose_excess = 1.2;
/// Share of the particles that may still move in a bed that counts as settled.
constexpr double moving_share = 0.01;

} // namespace

void PowderSpreading::insert_loose_bed(Simulation &simulation)
{
  const ParticleType &type = feedstock(simulation);
  const double largest = type.sizes.make()->largest();
  const ParticleArrays &particles = simulation.complete_step();

  double top = -apparatus.bed_depth;
  for (const std::size_t row : in_reservoir(particles, apparatus))
    top = std::max(top, particles.position[row].y + particles.radius(row));
  MPI_Allreduce(MPI_IN_PLACE, &top, 1, MPI_DOUBLE, MPI_MAX, simulation.communicator());

  VolumeGrid grid;
  grid.lower = {0., top, 0.};
  grid.upper = {apparatus.x_transfer, apparatus.y_top, apparatus.depth};
  grid.pitch = loose_pitch * largest;
  grid.offset = loose_offset * largest;
  grid.order = {0, 2, 1};
  // More than the bed takes, as what stands above the level is taken away; what is still missing
  // after settling is added then.
  const double height = apparatus.bed_depth + apparatus.bed_level;
  const double missing = n_fillings == 0 ? height : 0.2 * height;
  const auto n = std::min<std::size_t>(
      grid.capacity(),
      static_cast<std::size_t>(loose_excess * apparatus.particles_in_bed(type, missing)) + 1);

  simulation.insert_and_remove(
      loose_powder(simulation, p.particle_type, n, {0., -p.insertion_speed, 0.},
                   [&](std::size_t k, ParticleId id) { return grid.point(k, p.seed, id); }),
      {});
  phase_start = simulation.time();
  ++n_fillings;
}

void PowderSpreading::fill_reservoir(Simulation &simulation, const double platform_height)
{
  simulation.insert_and_remove(bed.stack(simulation, apparatus, platform_height, p.seed,
                                         series.first_layer + static_cast<unsigned int>(next_feed)),
                               in_the_way(simulation.complete_step(), apparatus));
}

bool PowderSpreading::has_settled(Simulation &simulation)
{
  const double waited = simulation.time() - phase_start;
  if (simulation.step_number() % settling_check != 0 || waited < p.settling_wait)
    return false;
  const ParticleArrays &particles = simulation.complete_step();
  unsigned long long count[2] = {0, 0};
  for (std::size_t row = 0; row < particles.n_owned; ++row) {
    // Not what lies on the plates since an earlier series.
    if (series.first_layer > 0 && !apparatus.is_in_reservoir(particles.position[row].vec()))
      continue;
    ++count[1];
    if (norm(particles.velocity[row].vec()) > p.settled_speed)
      ++count[0];
  }
  MPI_Allreduce(MPI_IN_PLACE, count, 2, MPI_UNSIGNED_LONG_LONG, MPI_SUM, simulation.communicator());
  // A few particles that still bounce on the surface do not delay the pass.
  const bool settled = static_cast<double>(count[0]) < moving_share * static_cast<double>(count[1]);
  if (!settled && waited < p.settling_time)
    return false;
  if (!settled)
    simulation.get_log().warning("after the settling time of " + format(p.settling_time) + " s, " +
                                 std::to_string(count[0]) + " of " + std::to_string(count[1]) +
                                 " particles of the feedstock still move faster than " +
                                 format(p.settled_speed) + " m/s; going on.");
  return true;
}

void PowderSpreading::go_on_after_settling(Simulation &simulation)
{
  const std::vector<std::size_t> above = above_level(simulation.complete_step(), apparatus);
  unsigned long long n_above = above.size();
  MPI_Allreduce(MPI_IN_PLACE, &n_above, 1, MPI_UNSIGNED_LONG_LONG, MPI_SUM,
                simulation.communicator());
  constexpr unsigned int most_fillings = 20;
  const ParticleType &type = feedstock(simulation);
  if (phase == Phase::settling_bed && !apparatus.is_full(type, n_above) &&
      n_fillings < most_fillings) {
    insert_loose_bed(simulation);
    return;
  }
  if (phase == Phase::settling_bed && !apparatus.is_full(type, n_above))
    simulation.get_log().warning("after " + std::to_string(n_fillings) +
                                 " fillings the powder in the reservoir still does not reach its "
                                 "level; going on with less.");
  simulation.insert_and_remove({}, above);
  if (phase == Phase::settling_bed) {
    bed.take(simulation, apparatus, -apparatus.bed_depth);
    simulation.get_log().line("The feedstock bed is at rest after " + format(simulation.time()) +
                              " s: " + std::to_string(bed.size()) + " particles");
    if (reservoir_depth() > apparatus.bed_depth) {
      lower_platform(simulation.time());
      simulation.renew_solids();
      fill_reservoir(simulation, -reservoir_depth());
      phase = Phase::settling_stack;
      phase_start = simulation.time();
      return;
    }
  }
  phase = Phase::passes;
  schedule_passes(simulation.time());
  next_feed = 1;
}

void PowderSpreading::lower_platform(const double time)
{
  lowering = time;
  apparatus.platform->add(time, 0., {0., apparatus.bed_depth - reservoir_depth(), 0.});
}

/// Depth of the powder in the reservoir before the first pass (m).
double PowderSpreading::reservoir_depth() const
{
  if (series.first_layer == 0)
    return apparatus.first_bed_depth;
  // The plates are covered, so no pass needs more powder than the others.
  const unsigned int n_strokes = p.feedstock == "full" ? p.n_layers - series.first_layer : 1;
  return apparatus.depth_for(n_strokes * p.stroke);
}

} // namespace eunoe::spreading
