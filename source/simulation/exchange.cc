// How particles come into a run and leave it.

#include <eunoe/simulation/simulation.h>

namespace eunoe {

namespace {

bool is_in_box(const Vec3 &x, const Vec3 &lower, const Vec3 &upper)
{
  return x.x >= lower.x && x.x <= upper.x && x.y >= lower.y && x.y <= upper.y && x.z >= lower.z &&
         x.z <= upper.z;
}

} // namespace

void Simulation::exchange(const Delivery &delivery, const std::vector<std::size_t> &removed)
{
  complete_step();
  const std::vector<std::size_t> lost = inspect();
  ParticleId first_new;
  {
    const Timers::Scope scope(timers, Section::search);
    first_new = system.exchange(delivery, removed, lost, solids);
    // The mesh was shared out before there were particles. This changes no result.
    const LoadBalancingParameters &balancing = parameters.load_balancing;
    if (step == 0 && system.imbalance(balancing) > balancing.threshold_at_start)
      system.search(solids, &balancing);
  }
  domain.keep_pose();
  solids_at_search.clear();
  for (const Solid &solid : solids)
    solids_at_search.push_back(solid.state);
  n_particles = system.n_global();
  if (sparse.is_enabled())
    update_sleep(true);
  system.start_forces_on_new(first_new, loads, solids, present_time);
}

void Simulation::insert_if_due()
{
  if (!insertion || insertion->finished())
    return;
  const unsigned int frequency = parameters.insertion.frequency;
  if (step != 0 && (frequency == 0 || step % frequency != 0))
    return;
  std::vector<std::size_t> removed;
  std::vector<bool> leaving(system.particles.size(), false);
  const InsertionParameters &p = parameters.insertion;
  if (p.removes)
    for (std::size_t row = 0; row < system.particles.size(); ++row)
      if (is_in_box(system.particles.position[row].vec(), p.removal_lower, p.removal_upper)) {
        leaving[row] = true;
        if (row < system.particles.n_owned)
          removed.push_back(row);
      }
  insertion->survey({domain, system.particles, leaving, solids, present_time});
  Delivery delivery;
  delivery.particles = insertion->next(ids);
  exchange(delivery, removed);
  ++n_insertions;
}

} // namespace eunoe
