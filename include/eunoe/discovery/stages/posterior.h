#ifndef eunoe_discovery_stages_posterior_h
#define eunoe_discovery_stages_posterior_h

#include <eunoe/discovery/stages/models.h>

namespace eunoe::discovery {

/// What is expected before any data, and how sure a verdict must be. Tuned on synthetic
/// laboratories; doc/discovery_json.md tells how.
struct Decision
{
  /// Probability of one, two or three effects of the catalogue, and of something else, given that
  /// something is missing; only their ratios count.
  double prior_of_size[3] = {1., 0.3, 0.1};
  /// Small, as a model that fits well needs no unknown effect; one that does not is refuted by its
  /// fit, not by this.
  double prior_off_catalogue = 0.06;
  /// What a further amplitude costs in deviance: the width of what is expected over that which the
  /// data leave, -2 log.
  double cost_of_effect = 5.2;
  /// Deviances are divided by this before they become probabilities.
  double temperature = 1.4;
  /// Share of the stated confidences that allows for errors that no doubt accounts for.
  double surprise = 0.1;
  /// The joint p-value is multiplied by this, as estimates from few runs make it too small.
  double safety_of_p = 1.5;
  /// Limits of amplitudes are where the deviance has risen by this many times what it rises by
  /// chance along one direction: fingerprints are uncertain in more than their noise.
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
  double least_inclusion = 0.02;        ///< an effect less likely than this is not confirmed
};

/// A set of effects and how likely it is.
struct Scored
{
  Fit fit;
  double score = 0.; ///< -2 log of evidence times prior, up to a constant
  double probability = 0.;
};

/// All sets of effects that were looked at, the likeliest first, beside "off catalogue".
struct Posterior
{
  std::vector<Scored> models;
  double off_catalogue = 0.;
  std::vector<double> inclusion; ///< of each effect: probability of all sets that hold it

  const Scored &best() const { return models.front(); }
};

/// Compares all single effects, all pairs, and triples about the best pairs, as far as
/// StudyOptions::max_effects goes.
Posterior compare_models(const Workbench &bench, const Decision &decision);

/// Effects whose amplitude can be told from runs.
bool is_simulated(const Workbench &bench, std::size_t effect);

} // namespace eunoe::discovery

#endif
