#include <eunoe/checkpoint/head_values.h>
#include <eunoe/simulation/measurement.h>

namespace eunoe {

nlohmann::ordered_json to_json(const std::vector<Measurement> &measurements)
{
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const Measurement &m : measurements)
    json.push_back({m.observable, m.index, m.value});
  return json;
}

std::vector<Measurement> measurements_in(const nlohmann::ordered_json &json)
{
  std::vector<Measurement> measurements;
  for (const auto &row : json) {
    if (!row.is_array() || row.size() != 3 || !row[0].is_string())
      throw std::invalid_argument("this is no measurement");
    measurements.push_back({row[0].get<std::string>(), count_in<int>(row[1]), number_in(row[2])});
  }
  return measurements;
}

} // namespace eunoe
