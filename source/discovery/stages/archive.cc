#include <eunoe/discovery/stages/archive.h>

#include <algorithm>
#include <limits>

namespace eunoe::discovery {

std::vector<RunResult> Archive::get(const std::vector<RunRequest> &requests)
{
  std::vector<RunRequest> missing;
  for (const RunRequest &request : requests) {
    if (!results.emplace(key(request), std::nullopt).second)
      continue;
    unsaved.push_back(key(request));
    const auto found = restored.find(key(request));
    if (found != restored.end())
      results[key(request)] = found->second;
    else
      missing.push_back(request);
  }
  if (!missing.empty()) {
    const std::vector<RunResult> made = source.run(missing);
    for (std::size_t k = 0; k < missing.size(); ++k)
      if (made[k] && made[k]->size() == source.data_points(missing[k].experiment).size())
        results[key(missing[k])] = made[k];
  }
  std::vector<RunResult> answer;
  for (const RunRequest &request : requests)
    answer.push_back(results.at(key(request)));
  return answer;
}

std::uint64_t Archive::n_failed() const
{
  return static_cast<std::uint64_t>(std::count_if(results.begin(), results.end(),
                                                  [](const auto &entry) { return !entry.second; }));
}

std::uint64_t Archive::remaining() const
{
  if (limit == 0)
    return std::numeric_limits<std::uint64_t>::max();
  const std::uint64_t used = n_requests() + reserved;
  return used < limit ? limit - used : 0;
}

nlohmann::ordered_json Archive::take_unsaved()
{
  nlohmann::ordered_json runs = nlohmann::ordered_json::array();
  for (const Key &entry : unsaved) {
    nlohmann::ordered_json amplitudes = nlohmann::ordered_json::object();
    for (const auto &[name, value] : std::get<1>(entry))
      amplitudes[name] = value;
    nlohmann::ordered_json row = {{"experiment", std::get<0>(entry)},
                                  {"amplitudes", amplitudes},
                                  {"seed", std::get<2>(entry)}};
    const RunResult &result = results.at(entry);
    row["values"] = result ? nlohmann::ordered_json(*result) : nlohmann::ordered_json(nullptr);
    runs.push_back(row);
  }
  unsaved.clear();
  return runs;
}

void Archive::restore(const nlohmann::ordered_json &runs)
{
  for (const auto &row : runs) {
    RunRequest request;
    request.experiment = row.at("experiment").get<std::string>();
    for (const auto &[name, value] : row.at("amplitudes").items())
      request.amplitudes[name] = value.get<double>();
    request.seed = row.at("seed").get<std::uint32_t>();
    RunResult result;
    if (!row.at("values").is_null()) {
      result.emplace();
      // JSON has no NaN; it is null there.
      for (const auto &value : row.at("values"))
        result->push_back(value.is_null() ? std::numeric_limits<double>::quiet_NaN()
                                          : value.get<double>());
    }
    restored[key(request)] = result;
  }
}

} // namespace eunoe::discovery
