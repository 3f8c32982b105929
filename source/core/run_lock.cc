#include <eunoe/core/first_rank.h>
#include <eunoe/core/machine.h>
#include <eunoe/core/problems.h>
#include <eunoe/core/run_lock.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <ctime>
#include <fcntl.h>
#include <fstream>
#include <set>
#include <sys/file.h>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>

namespace eunoe {

namespace {

/// A run that was just killed may need a moment to end, with all its ranks.
constexpr int most_tries = 25;
constexpr std::chrono::milliseconds between_tries(200);

/// Whether a file still has the name under which it was opened.
bool is_named(const int handle, const std::string &path)
{
  struct stat opened, named;
  return fstat(handle, &opened) == 0 && stat(path.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

/// Paths of the locks of this process.
std::set<std::string> &own_locks()
{
  static std::set<std::string> paths;
  return paths;
}

} // namespace

RunLock::RunLock(const std::string &path, const std::string &what, const std::string &mend,
                 MPI_Comm comm)
    : path(path)
{
  on_first_rank(comm, [&] {
    if (own_locks().count(path) > 0)
      return;
    for (int tries = 1; is_held_by_other(); ++tries) {
      if (tries == most_tries)
        throw UserError(what + " is in use by another run" + holder() + ". " + mend);
      std::this_thread::sleep_for(between_tries);
    }
    if (handle >= 0) {
      own_locks().insert(path);
      sign();
    }
  });
}

RunLock::~RunLock()
{
  if (handle < 0)
    return;
  // While it is locked: a run that waits for it finds that its file has lost its name.
  unlink(path.c_str());
  close(handle);
  own_locks().erase(path);
}

bool RunLock::is_held_by_other()
{
  constexpr mode_t for_all = 0666; // less the user's mask
  constexpr int most_takers = 100;
  for (int taker = 0; taker < most_takers; ++taker) {
    // Network file systems give an exclusive lock only on what is open for writing.
    const int file = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, for_all);
    if (file < 0) {
      why_not = std::strerror(errno);
      return false;
    }
    const int failure = flock(file, LOCK_EX | LOCK_NB) == 0 ? 0 : errno;
    if (failure == 0 && is_named(file, path)) {
      handle = file;
      return false;
    }
    close(file);
    if (failure == EWOULDBLOCK)
      return true;
    if (failure != 0 && failure != EINTR) {
      why_not = std::strerror(failure);
      unlink(path.c_str());
      return false;
    }
    // The run that held it has just ended and taken the file away.
  }
  why_not = "its files change all the time";
  return false;
}

void RunLock::sign() const
{
  const std::time_t now = std::time(nullptr);
  std::array<char, 32> time;
  std::strftime(time.data(), time.size(), "%Y-%m-%d %H:%M:%S", std::localtime(&now));
  const std::string text = "process " + std::to_string(getpid()) + " on " + host_name() +
                           ", since " + time.data() + "\n";
  // Only for people; a full disk does no harm here.
  if (ftruncate(handle, 0) == 0 && pwrite(handle, text.data(), text.size(), 0) > 0)
    fsync(handle);
}

std::string RunLock::holder() const
{
  std::ifstream stream(path);
  std::string text;
  std::getline(stream, text);
  return text.empty() ? "" : " (" + text + ")";
}

} // namespace eunoe
