#ifndef eunoe_discovery_inference_learning_curve_h
#define eunoe_discovery_inference_learning_curve_h

#include <eunoe/discovery/inference/describe.h>

namespace eunoe::discovery {

/// The answer after a round, by the number of runs: a row of discovery.json.
Json describe_round(const Findings &findings, const FactorSpace &space, std::uint64_t runs);

/// Whether the last three of such rows have the same answer; six where nothing is detected and p
/// lies near the level, which it may cross by chance.
bool is_steady(const Json &rounds, double level);

} // namespace eunoe::discovery

#endif
