#ifndef eunoe_discovery_simulator_h
#define eunoe_discovery_simulator_h

#include <eunoe/discovery/data_point.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace eunoe::discovery {

/// Amplitudes of factors by name; a factor that is not named is at its null value.
using Amplitudes = std::map<std::string, double>;

/// A simulation to run. Runs with equal seeds begin with the same powder and packing, until chaos
/// parts them.
struct RunRequest
{
  std::string experiment;
  Amplitudes amplitudes;
  std::uint32_t seed = 1;
};

/// Values of an experiment's data points, in the order of Simulator::data_points; none if the run
/// failed.
using RunResult = std::optional<std::vector<double>>;

/// Runs simulations, or returns the results of earlier ones. A study knows simulations
/// only through this interface, so that tests can give them models whose answer is known in closed
/// form.
class Simulator
{
public:
  virtual ~Simulator() = default;

  /// The data points that a run of an experiment gives.
  virtual const std::vector<DataPoint> &data_points(const std::string &experiment) const = 0;

  /// Runs all that is asked; the order of results is that of the requests. Collective. A repeated
  /// request costs nothing. Throws Interrupted (leaving what was run in the table) if the program
  /// was asked to stop.
  virtual std::vector<RunResult> run(const std::vector<RunRequest> &requests) = 0;

  /// Whether one of these effects can change an experiment; true without effects.
  virtual bool concerns(const std::string & /*experiment*/,
                        const std::vector<std::string> & /*effects*/) const
  {
    return true;
  }

  /// Results of earlier simulations of an experiment that need not be run again.
  virtual std::vector<std::pair<RunRequest, RunResult>> known(const std::string & /*experiment*/)
  {
    return {};
  }
};

/// Thrown when the program was asked to stop; what has been done is kept and the next start goes
/// on.
struct Interrupted
{
};

} // namespace eunoe::discovery

#endif
