#include <eunoe/core/files.h>
#include <eunoe/core/first_rank.h>
#include <eunoe/core/named_files.h>
#include <eunoe/core/sha256.h>

#include <boost/algorithm/string/trim.hpp>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace eunoe {
namespace {

EntryValues on_this_rank(const EntryValues &entries)
{
  EntryValues digests;
  for (const auto &[place, value] : entries) {
    std::error_code failure;
    std::istringstream parts(value);
    for (std::string name; std::getline(parts, name, ',');) {
      boost::trim(name);
      if (!std::filesystem::is_regular_file(name, failure))
        continue;
      std::ifstream stream(name, std::ios::binary);
      digests[place] += sha256(stream);
    }
  }
  return digests;
}

} // namespace

EntryValues named_files(const EntryValues &entries, MPI_Comm comm)
{
  nlohmann::json json;
  if (is_first_rank(comm))
    json = on_this_rank(entries);
  return nlohmann::json::parse(broadcast(json.dump(), comm)).get<EntryValues>();
}

} // namespace eunoe
