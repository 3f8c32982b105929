#include <eunoe/checkpoint/head_values.h>
#include <eunoe/engine/sleeper.h>
#include <eunoe/solids/saved_states.h>

#include <algorithm>

namespace eunoe {

namespace {

/// Whether a solid has moved, appeared or vanished since an earlier look.
bool stirs(const Solid &solid, const RigidState &before, const double time_before,
           const double time)
{
  const RigidState &now = solid.state;
  return norm_square(now.velocity) > 0. || norm_square(now.angular_velocity) > 0. ||
         displacement(solid, before, now) > 0. ||
         solid.is_active(time_before) != solid.is_active(time);
}

} // namespace

bool Sleeper::solid_starts(const double time, const std::vector<Solid> &solids) const
{
  // Near a solid that moved at the last look, all particles are awake. A solid that starts to move
  // needs a look at once: otherwise sleepers on it would miss its motion until the next regular
  // look and then feel all of it in one step.
  for (std::size_t s = 0; s < solids.size(); ++s) {
    const RigidState &before = last_states[s];
    const bool was_at_rest =
        norm_square(before.velocity) == 0. && norm_square(before.angular_velocity) == 0.;
    if (was_at_rest && stirs(solids[s], before, last_time, time))
      return true;
  }
  return false;
}

bool Sleeper::is_look_due(const Clock &clock, const std::vector<Solid> &solids) const
{
  return sparse.is_enabled() &&
         (clock.step() % sparse.frequency() == 0 || solid_starts(clock.time(), solids));
}

Stirring Sleeper::look(const Clock &clock, const std::vector<Solid> &solids,
                       const std::vector<std::unique_ptr<Load>> &loads, const bool wake_all)
{
  Stirring stirring;
  stirring.step = clock.step();
  stirring.everything = wake_all || std::any_of(loads.begin(), loads.end(), [&](const auto &load) {
                          return load->changes(last_time, clock.time());
                        });
  const bool is_first = last_states.empty();
  for (std::size_t s = 0; s < solids.size(); ++s)
    stirring.solid_moves.push_back(wake_all || is_first ||
                                   stirs(solids[s], last_states[s], last_time, clock.time()));
  last_time = clock.time();
  last_states = states_of(solids);
  return stirring;
}

nlohmann::ordered_json Sleeper::save() const
{
  return {{"last_time", last_time}, {"last_solids", to_json(last_states)}};
}

void Sleeper::load(const nlohmann::ordered_json &saved, const std::size_t n_solids)
{
  last_time = number_in(saved.at("last_time"));
  last_states = states_in(saved.at("last_solids"), n_solids);
}

} // namespace eunoe
