#ifndef eunoe_discovery_stages_archive_h
#define eunoe_discovery_stages_archive_h

#include <eunoe/discovery/laboratory.h>

#include <nlohmann/json.hpp>

#include <tuple>

namespace eunoe::discovery {

/// All runs that a study has asked for, so that no stage asks twice, and the count that the budget
/// limits: requests, not simulations, so that a study that goes on after a break decides the same.
class Archive
{
public:
  /// @param budget most requests; 0: no limit
  Archive(Laboratory &laboratory, std::uint64_t budget) : lab(laboratory), limit(budget) {}

  /// Results in the order of the requests.
  std::vector<RunResult> get(const std::vector<RunRequest> &requests);
  std::uint64_t n_requests() const { return results.size(); }
  std::uint64_t n_failed() const;
  /// How many more the budget allows, less what is set aside for later.
  std::uint64_t remaining() const;
  void set_aside(std::uint64_t requests) { reserved = requests; }

  Laboratory &laboratory() { return lab; }

  /// Runs that were asked for since the last call, and to put them back.
  nlohmann::ordered_json take_new();
  void absorb(const nlohmann::ordered_json &runs);

private:
  using Key = std::tuple<std::string, Amplitudes, std::uint32_t>;
  static Key key(const RunRequest &request)
  {
    return {request.experiment, request.amplitudes, request.seed};
  }

  Laboratory &lab;
  std::uint64_t limit, reserved = 0;
  std::map<Key, RunResult> results;
  std::map<Key, RunResult> stock; ///< of an earlier start; counts once it is asked for
  std::vector<Key> fresh;
};

} // namespace eunoe::discovery

#endif
