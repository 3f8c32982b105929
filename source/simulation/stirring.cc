// What wakes sleeping particles from outside.

#include <eunoe/simulation/simulation.h>

#include <algorithm>

namespace eunoe {

namespace {

/// Whether particles near a solid feel it move, appear or vanish since an earlier look at it.
bool stirs(const Solid &solid, const RigidState &before, const double time_before,
           const double time)
{
  const RigidState &now = solid.state;
  return norm_square(now.velocity) > 0. || norm_square(now.angular_velocity) > 0. ||
         displacement(solid, before, now) > 0. ||
         solid.is_active(time_before) != solid.is_active(time);
}

} // namespace

bool Simulation::solid_starts() const
{
  // Near one that moved at the last look, all are awake. What it would do in up to a whole check
  // frequency to those who rest on it and feel nothing would come all at once.
  for (std::size_t s = 0; s < solids.size(); ++s) {
    const RigidState &before = last_look.solids[s];
    const bool was_at_rest =
        norm_square(before.velocity) == 0. && norm_square(before.angular_velocity) == 0.;
    if (was_at_rest && stirs(solids[s], before, last_look.time, present_time))
      return true;
  }
  return false;
}

void Simulation::update_sleep(const bool wake_all)
{
  const Timers::Scope scope(timers, Section::sleep);
  Stirring stirring;
  stirring.step = step;
  stirring.everything =
      wake_all || std::any_of(loads.begin(), loads.end(), [this](const auto &load) {
        return load->changes(last_look.time, present_time);
      });
  for (std::size_t s = 0; s < solids.size(); ++s)
    stirring.solid_moves.push_back(
        wake_all || stirs(solids[s], last_look.solids[s], last_look.time, present_time));
  last_look.time = present_time;
  last_look.solids.clear();
  for (const Solid &solid : solids)
    last_look.solids.push_back(solid.state);
  system.update_sleep(sparse, stirring);
}

} // namespace eunoe
