#ifndef eunoe_core_timers_h
#define eunoe_core_timers_h

#include <array>
#include <mpi.h>
#include <string>

namespace eunoe {

/// Parts of a run whose time is measured.
enum class Section : unsigned int
{
  integration,
  search,
  sleep,
  ghosts,
  pairs,
  solids,
  loads,
  output,
  process,
  n
};

/// Wall-clock time spent in each part of the run.
class Timers
{
public:
  /// Adds the time of its own life to a section.
  class Scope
  {
  public:
    Scope(Timers &timers, Section section)
        : total(timers.seconds[static_cast<unsigned int>(section)]), start(MPI_Wtime())
    {
    }
    ~Scope() { total += MPI_Wtime() - start; }
    Scope(const Scope &) = delete;
    Scope &operator=(const Scope &) = delete;

  private:
    double &total;
    const double start;
  };

  static constexpr unsigned int n = static_cast<unsigned int>(Section::n);
  static std::string name(unsigned int section)
  {
    static const std::array<std::string, n> names = {
        {"integration", "contact search", "sleep", "ghosts", "particle contacts", "solid contacts",
         "loads", "output", "process"}};
    return names[section];
  }

  /// Seconds in a section, of this rank.
  double operator[](unsigned int section) const { return seconds[section]; }

private:
  std::array<double, n> seconds = {};
};

} // namespace eunoe

#endif
