#include "general_seed.h"

#include <boost/algorithm/string.hpp>

#include <cstdlib>

namespace eunoe {

namespace {

/// Warns if the last line that the user wrote for an entry asks for another seed.
void compare(const InputEntry &turned, const std::vector<InputEntry> &given, Problems &problems)
{
  for (auto entry = given.rbegin(); entry != given.rend(); ++entry)
    if (entry->path == turned.path && entry->name == turned.name) {
      if (std::strtol(entry->value.c_str(), nullptr, 10) != std::stol(turned.value))
        problems.warn(
            entry->where + ": " + describe(entry->path, entry->name),
            "is " + entry->value + " and gives way to the general seed, " + turned.value + ".", "");
      return;
    }
}

} // namespace

std::vector<InputEntry> turned_seeds(const int seed, const EntryValues &known,
                                     const std::vector<InputEntry> &given,
                                     const bool makes_insertion, Problems &problems)
{
  std::vector<InputEntry> turned;
  for (const auto &[place, value] : known) {
    const auto &[path, name] = place;
    if (name != "seed" && !boost::ends_with(name, " seed"))
      continue;
    if (makes_insertion && !path.empty() && path.front() == "insertion info")
      continue;
    InputEntry entry;
    entry.path = path;
    entry.name = name;
    entry.value = std::to_string(seed);
    compare(entry, given, problems);
    turned.push_back(entry);
  }
  return turned;
}

} // namespace eunoe
