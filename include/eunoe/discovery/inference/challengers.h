#ifndef eunoe_discovery_inference_challengers_h
#define eunoe_discovery_inference_challengers_h

#include <eunoe/discovery/inference/decision.h>

namespace eunoe::discovery {

/// Whether a model that is not in the answer could join it once it is known better: with a
/// twentieth of the probability, or, where it only adds an effect to a model of the answer, as the
/// likelier one of the two.
bool has_challenger(const Evidence &evidence, const Findings &findings);

/// Where nothing is detected: whether an effect would be if it is what it could be once it is known
/// better.
bool could_be_detected(const Evidence &evidence, const Findings &findings);

} // namespace eunoe::discovery

#endif
