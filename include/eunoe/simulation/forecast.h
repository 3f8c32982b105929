#ifndef eunoe_simulation_forecast_h
#define eunoe_simulation_forecast_h

#include <eunoe/core/problems.h>

#include <string>
#include <vector>

namespace eunoe {

class Log;

/// What can be known of a run before its first step. `--check` prints the same words as
/// the start of a run.
struct Forecast
{
  std::vector<std::string> facts; ///< lines for the user
  Problems problems;              ///< what forbids the run, and what is doubtful

  /// Facts, then doubts.
  void print(Log &log) const;
};

/// "There are 2 warnings" or "There is 1 warning", for the last line of a check.
std::string count_of_warnings(std::size_t n);

} // namespace eunoe

#endif
