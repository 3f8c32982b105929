#include <eunoe/checkpoint/head_values.h>
#include <eunoe/simulation/measurement.h>

#include <cstdio>
#include <map>

namespace eunoe {

std::string table_of(const std::vector<Measurement> &measurements,
                     const std::vector<ObservableDescription> &descriptions)
{
  std::map<std::string, std::string> units;
  for (const ObservableDescription &description : descriptions)
    units[description.name] = description.unit;
  std::string text = "observable,index,value,unit\n";
  for (const Measurement &m : measurements) {
    char value[32];
    std::snprintf(value, sizeof value, "%.17g", m.value);
    text += m.observable + "," + std::to_string(m.index) + "," + value + "," + units[m.observable] +
            "\n";
  }
  return text;
}

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
