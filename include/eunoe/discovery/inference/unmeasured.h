#ifndef eunoe_discovery_inference_unmeasured_h
#define eunoe_discovery_inference_unmeasured_h

#include <eunoe/discovery/inference/design.h>
#include <eunoe/discovery/inference/target.h>

#include <set>

namespace eunoe::discovery {

/// All data points of experiments as if each had been measured on the base model a few times
/// without an instrument's noise: what stands for data before there are any.
/// @param without data points that are left out
std::vector<MeasuredExperiment> imagined(const std::vector<std::string> &experiments,
                                         const Samples &samples,
                                         const std::set<DataPoint> &without = {});

/// What is known of experiments before anything is measured.
class Unmeasured
{
public:
  Unmeasured(const StudyOptions &options, const std::vector<std::string> &experiments,
             const std::vector<Factor> &factors, Simulator &simulator);

  /// Runs the base model and all effects.
  void run();

  /// The experiments, imagined as measured, beside their emulators.
  Target target() const;

  const std::vector<std::string> experiments;
  const FactorSpace space;
  Samples samples;
  Design design;
};

} // namespace eunoe::discovery

#endif
