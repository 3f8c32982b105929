#ifndef eunoe_discovery_laboratory_h
#define eunoe_discovery_laboratory_h

#include <eunoe/discovery/cell.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace eunoe::discovery {

/// Amplitudes of factors by name; a factor that is not named is at its null value.
using Amplitudes = std::map<std::string, double>;

/// One simulation to be made. Equal seeds give equal powders and packings as far as chaos lets
/// them (common random numbers).
struct RunRequest
{
  std::string experiment;
  Amplitudes amplitudes;
  std::uint32_t seed = 1;
};

/// Values of an experiment's cells, in the order of Laboratory::cells; none if the run failed.
using RunResult = std::optional<std::vector<double>>;

/// Where models are tried out: runs simulations, or remembers those that were run before. The
/// stages of a discovery know no more of simulations than this, so that they can be tested on
/// models whose answer is known in closed form.
class Laboratory
{
public:
  virtual ~Laboratory() = default;

  /// The cells that a run of an experiment gives.
  virtual const std::vector<Cell> &cells(const std::string &experiment) const = 0;

  /// Runs all that is asked; the order of results is that of the requests. Collective. A repeated
  /// request costs nothing. Throws Interrupted (leaving what was run in the cache) if the program
  /// was asked to stop.
  virtual std::vector<RunResult> run(const std::vector<RunRequest> &requests) = 0;

  /// Number of simulations that were really made so far, and of requests met from the cache.
  virtual std::uint64_t n_runs() const = 0;
  virtual std::uint64_t n_cached() const = 0;
};

/// Thrown when the program was asked to stop; what has been done is kept and the next start goes
/// on.
struct Interrupted
{
};

} // namespace eunoe::discovery

#endif
