#ifndef eunoe_discovery_inference_calibration_h
#define eunoe_discovery_inference_calibration_h

#include <eunoe/discovery/inference/twins.h>

#include <vector>

namespace eunoe::discovery {

/// What this study's own twins say of its probabilities and intervals (simulation-based
/// calibration; Talts and others 2018): truths are drawn from the prior, and their data go through
/// the same steps as the measured ones.
struct Calibration
{
  unsigned int twins = 0;         ///< in which something was detected
  double temperature = 1.;        ///< evidence is raised to its inverse
  double stated = 0., right = 0.; ///< mean probability of the first name; how often it was right
  double interval = 0.95;         ///< probability that an interval must hold for 95 % coverage
  double coverage = 0.;           ///< of intervals that hold 95 %
};

/// @param threshold of the log Bayes factor for a detection
Calibration calibrate(const Evidence &evidence, double threshold, unsigned int draws,
                      std::uint32_t seed);

/// Smallest amplitude on a side of an effect that is detected in four of five twins; nothing if
/// none in the range is.
std::optional<double> detectable(const Evidence &evidence, std::size_t effect, bool above,
                                 double threshold, std::uint32_t seed);

} // namespace eunoe::discovery

#endif
