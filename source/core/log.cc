#include <eunoe/core/log.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <unistd.h>

namespace eunoe {

namespace {

/// Whether someone watches standard output. An MPI launcher may give its processes a terminal
/// of its own while it writes to a file itself; then the launcher's output counts.
bool is_watched()
{
  if (isatty(STDOUT_FILENO) == 0)
    return false;
  if (std::getenv("OMPI_COMM_WORLD_RANK") == nullptr && std::getenv("PMI_RANK") == nullptr)
    return true;
  char target[256];
  const std::string link = "/proc/" + std::to_string(getppid()) + "/fd/1";
  const ssize_t length = readlink(link.c_str(), target, sizeof target);
  const std::string name(target, length > 0 ? static_cast<std::size_t>(length) : 0);
  return name.rfind("/dev/pts", 0) == 0 || name.rfind("/dev/tty", 0) == 0;
}

} // namespace

Log::Log(MPI_Comm comm, const bool quiet)
{
  int rank;
  MPI_Comm_rank(comm, &rank);
  active = rank == 0 && !quiet;
  terminal = active && is_watched();
}

Log::~Log()
{
  clear_bar();
}

void Log::clear_bar()
{
  if (bar_shown)
    std::fputs("\r\033[K", stdout);
  bar_shown = false;
}

void Log::line(const std::string &text)
{
  if (!active)
    return;
  clear_bar();
  std::printf("%s\n", text.c_str());
  std::fflush(stdout);
}

void Log::warning(const std::string &text)
{
  line("Warning: " + text);
}

void Log::error(const std::string &text)
{
  if (!active)
    return;
  clear_bar();
  std::fflush(stdout);
  std::fprintf(stderr, "%s\n", text.c_str());
}

void Log::progress(const Progress &p)
{
  if (!active)
    return;
  const double done_here = p.share - p.share_before;
  const double left = done_here > 0. ? p.elapsed * (1. - p.share) / done_here : 0.;
  char text[256];
  std::snprintf(text, sizeof text,
                "%5.1f %%  step %llu  t = %.6g s  %llu particles  %.2f M particle-steps/s  "
                "left: %s%s%s",
                100. * p.share, p.step, p.time, static_cast<unsigned long long>(p.particles),
                p.speed, done_here > 0. ? format_duration(left).c_str() : "?",
                p.stage.empty() ? "" : "  ", p.stage.c_str());
  if (!terminal) {
    line(text);
    return;
  }
  constexpr int width = 20;
  const int done = static_cast<int>(std::lround(std::clamp(p.share, 0., 1.) * width));
  std::printf("\r\033[K[%s%s] %s", std::string(done, '#').c_str(),
              std::string(width - done, '.').c_str(), text);
  std::fflush(stdout);
  bar_shown = true;
}

void Log::status(const std::string &text)
{
  if (terminal) {
    std::printf("\r\033[K%s", text.c_str());
    std::fflush(stdout);
    bar_shown = true;
  } else if (active && MPI_Wtime() - last_status > 60.) {
    last_status = MPI_Wtime();
    line(text);
  }
}

std::string format_duration(const double seconds)
{
  char text[48];
  const auto whole = static_cast<long long>(std::llround(seconds));
  if (seconds < 60.)
    std::snprintf(text, sizeof text, "%.1f s", seconds);
  else if (whole < 3600)
    std::snprintf(text, sizeof text, "%lld min %02lld s", whole / 60, whole % 60);
  else
    std::snprintf(text, sizeof text, "%lld h %02lld min", whole / 3600, whole % 3600 / 60);
  return text;
}

} // namespace eunoe
