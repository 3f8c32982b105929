#include <eunoe/engine/moving_solids.h>
#include <eunoe/solids/saved_states.h>

#include <algorithm>

namespace eunoe {

void MovingSolids::take(std::vector<Solid> &&all)
{
  solids = std::move(all);
  loads.resize(solids.size());
}

void MovingSolids::move_to(const double time)
{
  for (Solid &solid : solids)
    solid.state = solid.motion->at(time);
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
  for (SolidLoad &load : sums)
    for (unsigned int d = 0; d < 3; ++d) {
      load.force[d].reduce(comm);
      load.torque[d].reduce(comm);
    }
  return sums;
}

nlohmann::ordered_json MovingSolids::save() const
{
  nlohmann::ordered_json names = nlohmann::ordered_json::array();
  for (const Solid &solid : solids)
    names.push_back(solid.name);
  return {{"names", names}, {"states", to_json(at_search)}};
}

std::vector<std::pair<std::string, double>> MovingSolids::jumps(
    const nlohmann::ordered_json &saved) const
{
  const nlohmann::ordered_json &names = saved.at("names");
  const std::vector<RigidState> before = states_in(saved.at("states"), names.size());
  std::vector<std::pair<std::string, double>> list;
  for (std::size_t k = 0; k < names.size(); ++k)
    for (const Solid &solid : solids)
      if (names[k] == solid.name)
        list.emplace_back(solid.name, displacement(solid, before[k], solid.state));
  return list;
}

void MovingSolids::load(const nlohmann::ordered_json &saved)
{
  at_search = states_in(saved.at("states"), solids.size());
  for (std::size_t s = 0; s < solids.size(); ++s)
    solids[s].state = at_search[s];
}

} // namespace eunoe
