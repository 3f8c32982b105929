#include <eunoe/core/parameter_section.h>
#include <eunoe/core/problems.h>
#include <eunoe/engine/moving_solids.h>
#include <eunoe/solids/saved_states.h>

#include <algorithm>
#include <cmath>

namespace eunoe {

namespace {

/// Whether a wall stands where the mesh has it, at most turning or sliding in place; then its
/// centre is the origin or on the axis, and says nothing about its place.
bool is_in_place(const RigidState &wall)
{
  const Rotation unturned;
  return wall.rotation.x == unturned.x && wall.rotation.y == unturned.y &&
         (wall.centre == Vec3() || wall.angular_velocity != Vec3());
}

} // namespace

void MovingSolids::take(std::vector<Solid> &&all, const std::size_t number_of_given)
{
  solids = std::move(all);
  n_given = number_of_given;
  loads.resize(solids.size());
}

void MovingSolids::move_to(const double time)
{
  for (Solid &solid : solids) {
    solid.state = solid.motion->at(time);
    const RigidState &state = solid.state;
    if (!std::isfinite(norm(state.centre) + norm(state.velocity) + norm(state.angular_velocity)))
      throw UserError("'" + solid.name + "' has no place or velocity at t = " + format(time) +
                      " s: its motion is no finite number there. Correct its velocity, so that it "
                      "is one until the end of the run.");
  }
}

void MovingSolids::note_search()
{
  at_search = states_of(solids);
}

double MovingSolids::moved_since_search() const
{
  double most = 0.;
  for (std::size_t s = 0; s < solids.size(); ++s)
    most = std::max(most, displacement(solids[s], at_search[s], solids[s].state));
  return most;
}

std::vector<SolidLoad> &MovingSolids::new_loads()
{
  loads.assign(solids.size(), SolidLoad());
  return loads;
}

std::vector<SolidLoad> MovingSolids::global_loads(MPI_Comm comm) const
{
  std::vector<SolidLoad> sums = loads;
  // In one message, as each costs a latency.
  std::vector<ExactSum *> components;
  components.reserve(6 * sums.size());
  for (SolidLoad &load : sums)
    for (auto *const part : {&load.force, &load.torque})
      for (ExactSum &component : *part)
        components.push_back(&component);
  ExactSum::reduce(components, comm);
  return sums;
}

nlohmann::ordered_json MovingSolids::save() const
{
  return {{"names", names_of(solids)}, {"states", to_json(at_search)}};
}

std::vector<std::pair<std::string, double>> MovingSolids::jumps(
    const nlohmann::ordered_json &saved) const
{
  const auto names = saved.at("names").get<std::vector<std::string>>();
  const std::vector<RigidState> before = states_in(saved.at("states"), names.size());
  const std::vector<int> numbers = numbers_now(names, names_of(solids));
  std::vector<std::pair<std::string, double>> list;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const auto number = static_cast<std::size_t>(numbers[k]);
    if (numbers[k] < 0 || number >= n_given)
      continue;
    const Solid &solid = solids[number];
    if (!(solid.boundary && is_in_place(before[k]) && is_in_place(solid.state)))
      list.emplace_back(solid.name, displacement(solid, before[k], solid.state));
  }
  return list;
}

void MovingSolids::load(const nlohmann::ordered_json &saved)
{
  at_search = states_in(saved.at("states"), solids.size());
  for (std::size_t s = 0; s < solids.size(); ++s)
    solids[s].state = at_search[s];
}

} // namespace eunoe
