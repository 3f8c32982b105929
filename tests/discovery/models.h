#ifndef eunoe_tests_discovery_models_h
#define eunoe_tests_discovery_models_h

#include <eunoe/discovery/inference/decision.h>

#include <vector>

namespace test {

/// A model of these effects; without any it is "none of these".
inline eunoe::discovery::Model model_of(const std::vector<std::size_t> &effects,
                                        const double probability)
{
  eunoe::discovery::Model model;
  model.effects = effects;
  model.is_discrepancy = effects.empty();
  model.probability = probability;
  return model;
}

} // namespace test

#endif
