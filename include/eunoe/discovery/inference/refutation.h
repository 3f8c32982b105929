#ifndef eunoe_discovery_inference_refutation_h
#define eunoe_discovery_inference_refutation_h

#include <eunoe/discovery/inference/decision.h>

#include <functional>
#include <optional>

namespace eunoe::discovery {

/// Models that were tested on held-out data: those of the fit's answer first, as far as they go.
struct TestedModels
{
  std::vector<Model> models;
  std::vector<double> p; ///< of the data if the model is true
  /// Probability that data of something else would not refute the model.
  std::vector<double> passes;
  double p_nothing = 1.; ///< of the data if nothing is missing
};

/// What becomes of models that nothing has tested: they stay as long as they can still be tested.
/// In the end those fall with a refuted model that only add to it an effect which the fit does not
/// ask for.
enum class Untested
{
  stay,
  fall
};

/// Takes models that held-out data refute out of an answer and makes the verdict anew. That the
/// data have spared a model, which those of something else would not have done, makes "none of
/// these" less likely. Where the refuted models are all of the answer, tested models that are left
/// are a tie with "none of these"; without one, the answer stays what the fit gave, and the verdict
/// is off the catalogue. Without an answer nothing changes.
/// @param judge judges a model that has come to lead the answer by the data of the fit
/// @return place of the model that leads the answer among the tested ones; none if it is not there
std::optional<std::size_t> refute(const TestedModels &tested, Untested untested,
                                  const DecisionRule &rule,
                                  const std::function<void(Findings &)> &judge, Findings &findings);

} // namespace eunoe::discovery

#endif
