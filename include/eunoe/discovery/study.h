#ifndef eunoe_discovery_study_h
#define eunoe_discovery_study_h

#include <eunoe/core/log.h>
#include <eunoe/discovery/factor.h>
#include <eunoe/discovery/measured_data.h>
#include <eunoe/discovery/simulator.h>

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

namespace eunoe::discovery {

/// Options of a study. A *replicate* is one run of every experiment that is measured.
struct StudyOptions
{
  double level = 0.05;         ///< probability of a false alarm that is accepted
  unsigned int null_runs = 30; ///< replicates of the base model, at least 8
  /// Replicates on either side of each nuisance. The error of its estimated change looks like an
  /// effect that resembles it: 4 replicates instead of 8 give three times as many false alarms.
  unsigned int nuisance_runs = 10;
  unsigned int screen_runs = 2; ///< replicates at each of an effect's two amplitudes
  /// Whether a study that cannot decide if anything is missing runs two and a half times as many
  /// of the above and tests again. It does not if the budget has no room for that.
  bool second_look = true;
  unsigned int confirm_runs = 8; ///< further replicates for each leading effect, in each round
  unsigned int confirm_rounds = 3;
  unsigned int n_leaders = 4;     ///< largest number of effects that a round confirms
  unsigned int fit_runs = 8;      ///< replicates at the fitted amplitudes
  unsigned int validate_runs = 8; ///< runs of each held-out experiment, before and after each
  std::uint64_t budget = 0;       ///< largest number of runs (of one experiment each); 0: no limit
  unsigned int max_effects = 3;   ///< largest number of effects that one verdict names
  std::uint32_t seed = 1;         ///< of the study; its runs use seeds from 100000 * seed + 1 on

  /// Experiments that could be made but are not in the data: where a tie may be broken.
  std::vector<std::string> further_experiments;

  /// Relative error of the base model's values (period, time step, ...) that is forgiven.
  double model_tolerance = 0.;

  /// For ablation studies: whether fingerprints use paired seeds where that reduces their noise,
  /// whether there is a stage confirm, and whether thresholds account for estimated covariances.
  bool common_random_numbers = true, confirm = true, bootstrap = true;
};

/// Keeps the tables of the stages, so that a killed study continues where it was. A table of a
/// study with other data, factors or options is not used.
class StageStore
{
public:
  virtual ~StageStore() = default;

  /// The table of a stage, if there is one.
  virtual std::optional<nlohmann::ordered_json> load(const std::string &stage) = 0;
  virtual void save(const std::string &stage, const nlohmann::ordered_json &table) = 0;
};

/// Keeps the tables in memory only.
class TransientStore : public StageStore
{
public:
  std::optional<nlohmann::ordered_json> load(const std::string &stage) override
  {
    const auto found = tables.find(stage);
    return found == tables.end() ? std::nullopt : std::make_optional(found->second);
  }
  void save(const std::string &stage, const nlohmann::ordered_json &table) override
  {
    tables[stage] = table;
  }

private:
  std::map<std::string, nlohmann::ordered_json> tables;
};

enum class Verdict
{
  none,          ///< nothing is missing, as far as could be seen
  named,         ///< effects that are missing, each by its name
  tie,           ///< something is missing, one of several effects that look alike
  off_catalogue, ///< something is missing, and no effect of the catalogue explains it
  underpowered   ///< nothing was detected, and most effects could not have been
};

/// "none", "named", "tie", "off catalogue", "underpowered".
std::string name_of(Verdict verdict);

/// Exit code of a program that ends with this verdict: 0 for none, 10 to 13 for the others.
int exit_code(Verdict verdict);

/// The answer of a study.
struct Discovery
{
  Verdict verdict = Verdict::none;
  Amplitudes model_after;   ///< amplitudes of the named effects (tie: of the likeliest), else empty
  Amplitudes nuisances;     ///< best values of the nuisances together with these effects
  std::uint64_t n_runs = 0; ///< simulations that were asked for, however many came from a cache

  /// The content of discovery.json; doc/discovery_json.md describes it.
  nlohmann::ordered_json content;
};

/// Runs all stages: null, detect, screen, confirm, fit, iterate, validate. Collective: every rank
/// does the same arithmetic on the results that Simulator::run gives to all.
/// @param factors effects of the catalogue and nuisances of the base model
/// @param store called alike on every rank; `load` must give all the same, `save` may write on one
/// @throws UserError if data, factors and simulator do not fit together, or the budget is less
///   than null and screen need; Interrupted if the simulator was interrupted
Discovery discover(const StudyOptions &options, const MeasuredData &data,
                   const std::vector<Factor> &factors, Simulator &simulator, StageStore &store,
                   Log &log);

} // namespace eunoe::discovery

#endif
