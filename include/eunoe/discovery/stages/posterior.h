#ifndef eunoe_discovery_stages_posterior_h
#define eunoe_discovery_stages_posterior_h

#include <eunoe/discovery/stages/models.h>

namespace eunoe::discovery {

/// Prior probabilities and the thresholds of verdicts. Tuned on synthetic simulators;
/// doc/discovery_json.md says how.
struct DecisionRule
{
  /// Prior probability of one, two or three effects of the catalogue, and of something else, given
  /// that something is missing; only their ratios count.
  double prior_of_size[3] = {1., 0.3, 0.1};
  /// Small, because a model that fits well needs no unknown effect, and a model that does not is
  /// refuted by the p-value of its fit.
  double prior_off_catalogue = 0.06;
  /// Occam factor of a further amplitude: 2 log of its prior width over its posterior width.
  double cost_of_effect = 5.2;
  /// Deviances are divided by this before they become probabilities.
  double temperature = 1.4;
  /// Share of the stated confidences that is kept for errors outside the statistical model.
  double surprise = 0.1;
  /// Factor on the joint p-value, which estimates from few runs make too small.
  double safety_of_p = 1.5;
  /// Limits of amplitudes are where the deviance has risen by this many times what it rises by
  /// chance along one direction, because an emulator errs by more than its noise.
  double width_of_intervals = 1.75;
  /// Without a finding at the first look, more runs are made if its p-value is at most this; the
  /// level is shared between both looks (Bonferroni).
  double p_of_second_look = 0.5;
  double share_of_first_look = 0.25;
  double credible = 0.95;               ///< probability that a tie set covers
  double off_catalogue = 0.5;           ///< least probability for this verdict
  double p_of_bad_fit = 0.01;           ///< below: the best model does not describe the data
  double p_of_bad_held_out = 0.02;      ///< the same on held-out data
  double p_of_doubtful_held_out = 0.25; ///< below: more runs decide
  double least_inclusion = 0.02; ///< least posterior inclusion of an effect that is confirmed
};

/// A set of effects and its posterior probability.
struct ScoredModel
{
  Fit fit;
  double score = 0.; ///< -2 log of evidence times prior, up to a constant
  double probability = 0.;
};

/// Posterior probabilities of the sets of effects that were compared, the likeliest first, and of
/// "off catalogue".
struct Posterior
{
  std::vector<ScoredModel> models;
  double off_catalogue = 0.;
  std::vector<double> inclusion; ///< of each effect: probability of all sets that contain it

  const ScoredModel &best() const { return models.front(); }
};

/// Compares all single effects, all pairs, and triples about the best pairs, as far as
/// StudyOptions::max_effects goes.
Posterior compare_models(const StudyState &study, const DecisionRule &decision);

/// Whether there are runs of this effect alone.
bool is_simulated(const StudyState &study, std::size_t effect);

} // namespace eunoe::discovery

#endif
