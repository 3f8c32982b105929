#include <eunoe/core/problems.h>
#include <eunoe/discovery/inference/unmeasured.h>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

namespace {

/// The effect whose emulator is worst in the middle of its places, and its error there as a share
/// of the deviation of what is measured.
std::pair<std::string, double> least_known(const Evidence &evidence)
{
  std::pair<std::string, double> worst = {"nothing", 0.};
  for (const std::size_t k : evidence.usable()) {
    std::vector<double> errors;
    for (const Evidence::Place &place : evidence.places(k))
      errors.push_back(std::sqrt(evidence.target().unknown_share(place.hypothesis.prediction)));
    std::nth_element(errors.begin(), errors.begin() + errors.size() / 2, errors.end());
    if (const double middle = errors[errors.size() / 2]; middle > worst.second)
      worst = {evidence.space().effect(k).name, middle};
  }
  return worst;
}

} // namespace

void fill_table(const StudyOptions &options, const std::vector<std::string> &experiments,
                const std::vector<Factor> &factors, Simulator &simulator, Log &log)
{
  if (options.budget == 0)
    throw UserError("Without a limit a table is never full. Set 'budget of runs' to the number of "
                    "runs that it shall have.");
  Unmeasured unmeasured(options, experiments, factors, simulator);
  Samples &samples = unmeasured.samples;
  samples.set_aside(samples.n_known());
  if (samples.remaining() == 0) {
    log.line("The table has " + std::to_string(samples.n_known()) +
             " runs already. Increase 'budget of runs' to add more.");
    return;
  }
  unmeasured.run();
  bool goes_on = true;
  while (goes_on) {
    const Target target = unmeasured.target();
    const Evidence evidence(target, unmeasured.space);
    const auto [effect, error] = least_known(evidence);
    log.line("  " + std::to_string(samples.n_known() + samples.n_asked()) +
             " runs: least known is " + effect + ", within " + format_roughly(error) +
             " of the scatter of a measurement");
    goes_on = unmeasured.design.fill(evidence);
  }
}

} // namespace eunoe::discovery
