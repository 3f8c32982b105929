#ifndef eunoe_discovery_inference_decision_h
#define eunoe_discovery_inference_decision_h

#include <eunoe/discovery/inference/calibration.h>
#include <eunoe/discovery/inference/lookalikes.h>
#include <eunoe/discovery/study.h>
#include <eunoe/discovery/tuned.h>

#include <vector>

namespace eunoe::discovery {

/// What a study has found so far.
struct Findings
{
  double log_bayes_factor = 0., p_nothing = 1.;
  double threshold = 0.; ///< of the log Bayes factor at the study's level
  bool detected = false;
  Calibration calibration;
  Lookalikes lookalikes;      ///< if something is detected
  std::vector<Model> models;  ///< with calibrated probabilities, the likeliest first
  std::vector<Model> answer;  ///< those that the data do not tell apart, without "none of these"
  bool none_of_these = false; ///< whether that is among them
  double p_fit = 1.;          ///< of the closest model's fit
  double off_catalogue = 0.;  ///< probability of "none of these"
  Verdict verdict = Verdict::none;
};

/// Tests whether anything is missing, weighs the models and calibrates.
Findings weigh(const Evidence &evidence, const StudyOptions &options, const DecisionRule &rule);

/// Whether the model that leads an answer describes the data, and the verdict that follows.
void judge(const Evidence &evidence, const DecisionRule &rule, std::uint32_t seed,
           Findings &findings);

/// The model of the catalogue that comes closest: the first of the answer, or the likeliest where
/// there is none; null if no effect was simulated.
const Model *closest_model(const Findings &findings);

/// Chooses the answer: the likeliest models, as many as have the probability of one together.
void choose(const DecisionRule &rule, Findings &findings);

/// Effects of the catalogue without any result may be what is missing: with one, no other is named
/// outright; with most, nobody knows whether the catalogue has it.
void allow_for_untried(std::size_t untried, std::size_t effects, Findings &findings);

/// Of an answer that is chosen: no model, one, or several.
Verdict verdict_of(const Findings &findings);

/// Whether a model that is not in the answer could join it once it is known better: with a
/// twentieth of the probability, or, where it only adds an effect to a model of the answer, as the
/// likelier one of the two.
bool has_challenger(const Evidence &evidence, const Findings &findings);

/// Where nothing is detected: whether an effect would be if it is what it could be once it is known
/// better.
bool could_be_detected(const Evidence &evidence, const Findings &findings);

/// Probability that an effect is among those that are missing.
double probability_of(const std::vector<Model> &models, std::size_t effect);

} // namespace eunoe::discovery

#endif
