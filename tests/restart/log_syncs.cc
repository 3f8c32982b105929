// Loaded before a program (LD_PRELOAD): logs the program's calls of fsync and rename with the names
// of the files, in their order, to the file named in SYNC_LOG.

#include <cstdio>
#include <cstdlib>
#include <dlfcn.h>
#include <string>
#include <unistd.h>

namespace {

void note(const std::string &line)
{
  const char *const name = std::getenv("SYNC_LOG");
  std::FILE *const log = name == nullptr ? nullptr : std::fopen(name, "a");
  if (log == nullptr)
    return;
  std::fprintf(log, "%s\n", line.c_str());
  std::fclose(log);
}

} // namespace

extern "C" int fsync(int handle)
{
  using Function = int (*)(int);
  static const auto original = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "fsync"));
  char path[4096];
  const ssize_t length =
      readlink(("/proc/self/fd/" + std::to_string(handle)).c_str(), path, sizeof path);
  note("sync " + std::string(path, length > 0 ? static_cast<std::size_t>(length) : 0));
  return original(handle);
}

extern "C" int rename(const char *from, const char *to)
{
  using Function = int (*)(const char *, const char *);
  static const auto original = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "rename"));
  note("name " + std::string(to));
  return original(from, to);
}
