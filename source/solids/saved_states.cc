#include <eunoe/checkpoint/head_values.h>
#include <eunoe/solids/saved_states.h>

#include <deque>
#include <map>

namespace eunoe {

using Json = nlohmann::ordered_json;

Json to_json(const RigidState &s)
{
  Json numbers;
  for (const Vec3 &v :
       {s.centre, s.rotation.x, s.rotation.y, s.rotation.z, s.velocity, s.angular_velocity})
    for (unsigned int d = 0; d < 3; ++d)
      numbers.push_back(v[d]);
  return numbers;
}

Json to_json(const std::vector<RigidState> &states)
{
  Json list = Json::array();
  for (const RigidState &state : states)
    list.push_back(to_json(state));
  return list;
}

RigidState state_in(const Json &json)
{
  RigidState s;
  unsigned int k = 0;
  for (Vec3 *const v :
       {&s.centre, &s.rotation.x, &s.rotation.y, &s.rotation.z, &s.velocity, &s.angular_velocity})
    for (unsigned int d = 0; d < 3; ++d)
      (*v)[d] = number_in(json.at(k++));
  return s;
}

std::vector<RigidState> states_in(const Json &json, const std::size_t n)
{
  std::vector<RigidState> states;
  for (std::size_t k = 0; k < n; ++k)
    states.push_back(state_in(json.at(k)));
  return states;
}

std::vector<int> numbers_now(const std::vector<std::string> &saved,
                             const std::vector<std::string> &present)
{
  std::map<std::string, std::deque<int>> left;
  for (std::size_t k = 0; k < present.size(); ++k)
    left[present[k]].push_back(static_cast<int>(k));
  std::vector<int> numbers;
  for (const std::string &name : saved) {
    std::deque<int> &of_name = left[name];
    numbers.push_back(of_name.empty() ? -1 : of_name.front());
    if (!of_name.empty())
      of_name.pop_front();
  }
  return numbers;
}

std::vector<std::string> names_of(const std::vector<Solid> &solids)
{
  std::vector<std::string> names;
  for (const Solid &solid : solids)
    names.push_back(solid.name);
  return names;
}

std::vector<RigidState> states_of(const std::vector<Solid> &solids)
{
  std::vector<RigidState> states;
  for (const Solid &solid : solids)
    states.push_back(solid.state);
  return states;
}

} // namespace eunoe
