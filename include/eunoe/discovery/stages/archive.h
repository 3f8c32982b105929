#ifndef eunoe_discovery_stages_archive_h
#define eunoe_discovery_stages_archive_h

#include <eunoe/discovery/simulator.h>

#include <nlohmann/json.hpp>

#include <tuple>

namespace eunoe::discovery {

/// The results of all runs that a study has asked for, so that no run is asked for twice, and their
/// number, which the budget limits. Requests count and not simulations, so that a study that
/// continues after a break takes the same decisions.
class Archive
{
public:
  /// @param budget most requests; 0: no limit
  Archive(Simulator &simulator, std::uint64_t budget) : source(simulator), limit(budget) {}

  /// Results in the order of the requests.
  std::vector<RunResult> get(const std::vector<RunRequest> &requests);
  std::uint64_t n_requests() const { return results.size(); }
  std::uint64_t n_failed() const;
  /// Number of further requests within the budget, less those that are set aside for later.
  std::uint64_t remaining() const;
  void set_aside(std::uint64_t requests) { reserved = requests; }

  Simulator &simulator() { return source; }

  /// The results that were asked for since the last call, and the way back: results that an earlier
  /// start of the study had saved.
  nlohmann::ordered_json take_unsaved();
  void restore(const nlohmann::ordered_json &runs);

private:
  using Key = std::tuple<std::string, Amplitudes, std::uint32_t>;
  static Key key(const RunRequest &request)
  {
    return {request.experiment, request.amplitudes, request.seed};
  }

  Simulator &source;
  std::uint64_t limit, reserved = 0;
  std::map<Key, RunResult> results;
  std::map<Key, RunResult> restored; ///< from an earlier start; they count once they are asked for
  std::vector<Key> unsaved;
};

} // namespace eunoe::discovery

#endif
