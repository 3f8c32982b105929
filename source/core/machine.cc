#include <eunoe/core/machine.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace eunoe {

namespace fs = std::filesystem;

namespace {

/// The nearest folder around a path that exists.
fs::path nearest_existing(const std::string &path)
{
  std::error_code failure;
  fs::path place = fs::absolute(path, failure).lexically_normal();
  while (!fs::exists(place, failure) && place.has_relative_path())
    place = place.parent_path();
  return place;
}

} // namespace

std::string host_name()
{
  std::array<char, 256> name = {};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "an unknown host";
}

double usable_memory()
{
  const long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGE_SIZE);
  double memory = pages > 0 && size > 0 ? static_cast<double>(pages) * size : 0.;
  for (const char *const file :
       {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"})
  {
    double limit = 0.;
    // Without a limit the file has the word "max" or an enormous number.
    if (std::ifstream(file) >> limit && limit > 0. && (memory == 0. || limit < memory))
      memory = limit;
  }
  return memory;
}

double free_disk_space(const std::string &path)
{
  std::error_code failure;
  const fs::space_info space = fs::space(nearest_existing(path), failure);
  return failure ? 0. : static_cast<double>(space.available);
}

std::string obstacle_to_folder(const std::string &path)
{
  if (path.empty())
    return "it has no name";
  const fs::path place = nearest_existing(path);
  std::error_code failure;
  if (!fs::is_directory(place, failure))
    return failure ? failure.message() : place.string() + " is a file";
  if (access(place.c_str(), W_OK | X_OK) != 0)
    return place.string() + ": " + std::strerror(errno);
  return "";
}

std::string format_bytes(const double bytes)
{
  char text[32];
  if (bytes < 1e9)
    std::snprintf(text, sizeof text, "%.3g MB", bytes / 1e6);
  else
    std::snprintf(text, sizeof text, "%.4g GB", bytes / 1e9);
  return text;
}

} // namespace eunoe
