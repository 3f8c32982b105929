#ifndef eunoe_discovery_study_h
#define eunoe_discovery_study_h

#include <eunoe/core/log.h>
#include <eunoe/discovery/factor.h>
#include <eunoe/discovery/measured_data.h>
#include <eunoe/discovery/simulator.h>

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace eunoe::discovery {

/// Options of a study. A *replicate* is one run of every experiment that is measured.
struct StudyOptions
{
  double level = 0.02;             ///< probability of a false alarm that is accepted
  unsigned int null_runs = 30;     ///< first replicates of the base model, at least 8
  unsigned int nuisance_runs = 10; ///< first replicates on either side of each nuisance
  unsigned int validate_runs = 8;  ///< runs of each held-out experiment for each model
  std::uint64_t budget = 2000;     ///< largest number of runs (of one experiment each); 0: no limit
  std::uint32_t seed = 1;          ///< of the study; its runs use seeds from 100000 * seed + 1 on

  /// Experiments that could be made but are not in the data: where a tie may be broken.
  std::vector<std::string> further_experiments;

  /// Relative error of the base model's values (period, time step, ...) that is forgiven.
  double model_tolerance = 0.;
};

enum class Verdict
{
  none,          ///< nothing is missing, as far as could be seen
  named,         ///< effects that are missing, each by its name
  tie,           ///< something is missing, one of several effects that look alike
  off_catalogue, ///< something is missing, and no effect of the catalogue explains it
  underpowered   ///< nothing was detected, and most effects could not have been; or something
                 ///< was, and of most effects there is no run
};

/// "none", "named", "tie", "off catalogue", "underpowered".
std::string name_of(Verdict verdict);

/// Exit code of a program that ends with this verdict: 0 for none, 10 to 13 for the others.
int exit_code(Verdict verdict);

/// The answer of a study.
struct Discovery
{
  Verdict verdict = Verdict::none;
  Amplitudes model_after; ///< amplitudes of the named effects (tie: of the likeliest), else empty

  /// The content of discovery.json; doc/discovery_json.md describes it.
  nlohmann::ordered_json content;
};

/// Makes a study: runs the base model, nuisances and effects; then runs where it is expected to
/// tell most, until the answer no longer changes or the budget is spent; tests the answer on
/// held-out data. Collective: every rank does the same arithmetic on the results that
/// Simulator::run gives to all.
/// @param factors effects of the catalogue and nuisances of the base model
/// @throws UserError if data, factors and simulator do not fit together, or the budget is less
///   than the base model needs; Interrupted if the simulator was interrupted
Discovery discover(const StudyOptions &options, const MeasuredData &data,
                   const std::vector<Factor> &factors, Simulator &simulator, Log &log);

/// Without measured data: which experiments and observables are expected to tell most about which
/// effect is missing, from runs of the base model and of all effects.
/// @return rows "experiment", "observable", "information" (bit), "of" (bit)
nlohmann::ordered_json plan(const StudyOptions &options,
                            const std::vector<std::string> &experiments,
                            const std::vector<Factor> &factors, Simulator &simulator, Log &log);

/// Without measured data: fills the table of runs for studies to come, until it has as many as the
/// budget says. Runs the base model and all effects, then where the emulators know least; what is
/// measured later is answered from the table with few runs more.
/// @throws UserError if the budget has no limit, or is less than the base model needs
void fill_table(const StudyOptions &options, const std::vector<std::string> &experiments,
                const std::vector<Factor> &factors, Simulator &simulator, Log &log);

} // namespace eunoe::discovery

#endif
