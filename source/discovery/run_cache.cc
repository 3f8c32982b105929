#include <eunoe/core/files.h>
#include <eunoe/core/problems.h>
#include <eunoe/core/version.h>
#include <eunoe/discovery/run_cache.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace eunoe::discovery {

namespace fs = std::filesystem;

nlohmann::ordered_json to_json(const RunRecord &record)
{
  nlohmann::ordered_json json;
  json["failure"] = record.failure;
  json["core_seconds"] = record.core_seconds;
  auto &list = json["measurements"] = nlohmann::ordered_json::array();
  for (const Measurement &m : record.measurements)
    list.push_back({m.observable, m.index, m.value}); // JSON has no NaN; it becomes null
  return json;
}

RunRecord record_from(const nlohmann::ordered_json &json)
{
  RunRecord record;
  record.failure = json.at("failure").get<std::string>();
  record.core_seconds = json.at("core_seconds").get<double>();
  for (const auto &m : json.at("measurements"))
    record.measurements.push_back({m.at(0).get<std::string>(), m.at(1).get<int>(),
                                   m.at(2).is_null() ? std::nan("") : m.at(2).get<double>()});
  return record;
}

void RunCache::open()
{
  create_folder(folder, comm);
}

std::string RunCache::file(const std::string &key) const
{
  return folder + "/" + key.substr(0, 2) + "/" + key + ".json";
}

std::map<std::string, RunRecord> RunCache::load(const std::set<std::string> &keys) const
{
  int rank;
  MPI_Comm_rank(comm, &rank);
  auto found = nlohmann::ordered_json::object();
  if (rank == 0)
    for (const std::string &key : keys) {
      std::ifstream stream(file(key), std::ios::binary);
      if (!stream)
        continue;
      try {
        const auto json = nlohmann::ordered_json::parse(stream);
        record_from(json);
        if (json.at("key") == key)
          found[key] = json;
      } catch (const nlohmann::json::exception &) {
        continue;
      }
    }
  std::map<std::string, RunRecord> records;
  const auto all = nlohmann::ordered_json::parse(broadcast(found.dump(), comm));
  for (const auto &[key, json] : all.items())
    records[key] = record_from(json);
  return records;
}

void RunCache::store(const std::string &key, const RunRecord &record,
                     const nlohmann::ordered_json &about) const
{
  nlohmann::ordered_json json;
  json["key"] = key;
  json["version"] = version();
  json["git_revision"] = git_revision();
  json["engine"] = engine_digest();
  json.update(about);
  json.update(to_json(record));
  std::error_code failure;
  fs::create_directories(fs::path(file(key)).parent_path(), failure);
  // Two programs may make the same run at the same time: each writes beside it under its own name.
  const std::string beside = file(key) + "." + std::to_string(getpid());
  write_file(beside, json.dump(1) + "\n");
  fs::rename(beside, file(key), failure);
  if (failure)
    throw UserError(file(key) + " cannot be written: " + failure.message() + ".");
}

} // namespace eunoe::discovery
