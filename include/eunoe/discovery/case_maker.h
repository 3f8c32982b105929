#ifndef eunoe_discovery_case_maker_h
#define eunoe_discovery_case_maker_h

#include <eunoe/discovery/experiment.h>

#include <map>
#include <utility>

namespace eunoe::discovery {

/// A request as it is run.
struct StudyCase
{
  const Experiment *experiment;
  std::vector<std::string> overrides;
  std::string key;     ///< hash of the complete input, with the files that it names
  std::string problem; ///< why it cannot be run; empty if it can
  bool names_files = false;
  RunRequest request;
};

/// Makes cases of a study from what is requested, and tells their keys. Making a case takes
/// milliseconds, so keys are remembered by recipe, which is a hash of what a case is made from.
class CaseMaker
{
public:
  /// @param factors effects and nuisances that requests may name
  CaseMaker(const std::vector<Experiment> &experiments, const std::vector<Effect> &factors,
            MPI_Comm comm)
      : experiments(experiments), factors(factors), comm(comm)
  {
  }

  /// Takes keys by recipe that were found earlier, and gives those found since the last call.
  void remember(std::map<std::string, std::string> keys) { keys_by_recipe = std::move(keys); }
  std::map<std::string, std::string> new_keys() { return std::exchange(found, {}); }

  const Experiment &find(const std::string &name) const;

  /// Whether the study has the experiment and all factors of a request.
  bool is_of_study(const RunRequest &request) const;

  /// Collective.
  StudyCase make(const RunRequest &request) const;

  /// The key of a case, which is made only if no recipe tells it; collective.
  std::string key(const RunRequest &request);

private:
  const std::vector<Experiment> &experiments;
  const std::vector<Effect> &factors;
  std::map<std::string, std::string> keys_by_recipe, found;
  MPI_Comm comm;
};

/// A text that is the same for equal requests.
std::string text_of(const RunRequest &request);

} // namespace eunoe::discovery

#endif
