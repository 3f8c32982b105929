#include <eunoe/discovery/inference/design.h>
#include <eunoe/discovery/inference/imagined.h>

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
    for (const Evidence::Place &place : evidence.places(k)) {
      const Target::Prediction &prediction = place.hypothesis.prediction;
      errors.push_back(std::sqrt(
          (prediction.leverage.array() / evidence.target().variance(prediction).array()).mean()));
    }
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
  constexpr unsigned int repeats = 4;
  const FactorSpace space(factors);
  Samples samples(options, space, simulator, experiments);
  Design design(options, space, samples, experiments);
  design.run_base();
  const auto estimate = [&] {
    return Target(imagined(experiments, samples, simulator, repeats), samples, space, 0.);
  };
  design.run_effects(estimate);
  bool goes_on = true;
  while (goes_on) {
    const Target target = estimate();
    const Evidence evidence(target, space);
    const auto [effect, error] = least_known(evidence);
    log.line("  " + std::to_string(samples.n_known() + samples.n_asked()) +
             " runs: least known is " + effect + ", within " + format_roughly(error) +
             " of the scatter of a measurement");
    goes_on = design.fill(evidence);
  }
}

} // namespace eunoe::discovery
