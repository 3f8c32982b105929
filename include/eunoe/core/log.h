#ifndef eunoe_core_log_h
#define eunoe_core_log_h

#include <cstdint>
#include <mpi.h>
#include <string>

namespace eunoe {

/// What the user reads while a run goes on, written by the first rank: lines, and a progress bar
/// where standard output is a terminal.
class Log
{
public:
  /// @param quiet writes nothing, for runs inside other programs
  explicit Log(MPI_Comm comm, bool quiet = false);
  ~Log();

  void line(const std::string &text);
  void warning(const std::string &text);
  /// To the standard error stream, so that output which is passed on stays clean.
  void error(const std::string &text);

  /// What a run has done so far.
  struct Progress
  {
    unsigned long long step = 0;
    double share = 0.;        ///< of the whole run, in [0, 1]
    double share_before = 0.; ///< that an earlier part of the run had done
    double time = 0.;         ///< simulated (s)
    std::uint64_t particles = 0;
    double speed = 0.;   ///< million particle-steps/s
    double elapsed = 0.; ///< wall clock (s)
    std::string stage;   ///< what a process is doing
  };

  /// Renews the bar on a terminal, else writes a line.
  void progress(const Progress &progress);

  /// Renews a line of text on a terminal; elsewhere writes one a minute.
  void status(const std::string &text);

  bool is_terminal() const { return terminal; }

private:
  void clear_bar();

  bool active, terminal, bar_shown = false;
  double last_status = 0.;
};

/// "1 h 05 min", "2 min 03 s", "4.2 s".
std::string format_duration(double seconds);

} // namespace eunoe

#endif
