#ifndef eunoe_discovery_inference_imagined_h
#define eunoe_discovery_inference_imagined_h

#include <eunoe/discovery/inference/target.h>

namespace eunoe::discovery {

/// All data points of experiments as if each had been measured on the base model a few times
/// without an instrument's noise: what stands for data before there are any.
std::vector<MeasuredExperiment> imagined(const std::vector<std::string> &experiments,
                                         const Samples &samples, const Simulator &simulator,
                                         unsigned int repeats);

} // namespace eunoe::discovery

#endif
