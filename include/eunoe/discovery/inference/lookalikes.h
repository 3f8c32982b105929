#ifndef eunoe_discovery_inference_lookalikes_h
#define eunoe_discovery_inference_lookalikes_h

#include <eunoe/discovery/inference/evidence.h>

#include <map>
#include <vector>

namespace eunoe::discovery {

/// What the catalogue says of an effect that it lacks. Each of its effects is left out in turn, and
/// the others weigh its twins: an effect that none of them resembles looks like no other, and a law
/// of attraction looks like the other laws of attraction. What the catalogue really lacks is taken
/// to have as many relatives in it as its own effects have. Only twins in which the others detect
/// something count, as there is an answer only where something was detected.
struct Lookalikes
{
  double strength = 0.;                    ///< of the twins, in standard deviations of a run
  std::map<std::size_t, double> taken_for; ///< mean probability that goes to each other effect
  double recognised = 1.;                  ///< and to "none of the catalogue"

  /// Log evidence of "none of the catalogue" with its share of effects that look like others.
  /// @param models with the evidence of each single effect and of the discrepancy
  /// @param temperature by which evidence is divided, and shares are not
  double log_evidence(const std::vector<Model> &models, double temperature) const;
};

/// @param strength of the data: who is confused with whom depends on it. Effects that do not reach
/// it cannot be what was measured, and have no twins.
/// @param threshold of the log Bayes factor for a detection
/// @param draws of all effects together
Lookalikes find_lookalikes(const Evidence &evidence, double strength, double threshold,
                           unsigned int draws, std::uint32_t seed);

} // namespace eunoe::discovery

#endif
