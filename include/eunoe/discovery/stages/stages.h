#ifndef eunoe_discovery_stages_stages_h
#define eunoe_discovery_stages_stages_h

#include <eunoe/discovery/stages/posterior.h>
#include <eunoe/discovery/stages/reference.h>

#include <nlohmann/json.hpp>

namespace eunoe::discovery {

/// What the stages have found so far.
struct Findings
{
  Decision decision;

  // detect
  Reference base_reference;
  Evidence evidence; ///< against the base model; with the gain once fingerprints are known
  double p_global = 1.;

  // screen
  Reference reference;
  double p_detected = 1.;  ///< of all evidence together
  bool p_is_bound = false; ///< no draw of the bootstrap reaches the evidence: it is less likely yet
  bool detected = false;

  // confirm, fit, iterate
  Posterior posterior;
  Scored chosen;     ///< the effects that go into the model, with no effect if nothing was detected
  double p_fit = 1.; ///< whether the chosen model describes the data

  Verdict verdict = Verdict::none;
  std::vector<Scored> tie; ///< sets of effects that cannot be told apart, the likeliest first
  std::vector<double> confidence; ///< of each effect
  double off_catalogue = 0.;      ///< confidence in "something else"
  std::vector<EffectSet> refuted; ///< sets of the tie that held-out data speak against
  bool withdrawn = false;
};

using Table = nlohmann::ordered_json;

/// Each stage makes its runs, adds to the findings, and returns its table (doc/discovery_json.md).
Table stage_null(Workbench &bench);
Table stage_detect(Workbench &bench, Findings &findings);
Table stage_screen(Workbench &bench, Findings &findings);
Table stage_confirm(Workbench &bench, Findings &findings);
Table stage_fit(Workbench &bench, Findings &findings);
Table stage_iterate(Workbench &bench, Findings &findings);
Table stage_validate(Workbench &bench, Findings &findings);

/// Makes sets of runs of the base model, and of it with each nuisance on either side, so that there
/// are this many in all.
void ask_base_runs(Workbench &bench, unsigned int base, unsigned int nuisance);

/// Estimates chaos, the data's noise and the misfit anew from all runs so far.
void settle_chaos(Workbench &bench);
/// The same, and what nuisances change.
void settle_noise(Workbench &bench);
/// What evidence would be were nothing missing, and the tail of the misfit that it shows.
void settle_base_reference(Workbench &bench, Findings &findings);

/// What could be the likeliest sets once their fingerprints are known well, the first first. A
/// set's evidence suffers from what few runs leave unknown of its fingerprints, which is what
/// confirming mends: without that share of it, sets of which little is known are not passed over
/// for "something else". Neither are those that lie far before the amplitudes that were run, where
/// they may do other things than what is foreseen. Probabilities are among the sets alone.
std::vector<Scored> promising(const Workbench &bench, const Posterior &posterior,
                              const Decision &decision);

/// Verdict, tie set and confidences from the posterior.
void decide(Findings &findings);
/// Confidences alone, once sets of effects have been refuted.
void settle_confidence(Findings &findings);

/// Sets of effects as a table: effects, probability, amplitudes.
Table describe_models(const Workbench &bench, const std::vector<Scored> &models);

/// What could be measured to tell the sets of a tie apart, the best first.
Table separating_measurements(Workbench &bench, const std::vector<Scored> &tie);

/// What remains of the data beside the closest model: where, and what it resembles.
Table describe_remainder(const Workbench &bench, const Findings &findings);

/// Probability that data are as far from a model as these, were it true.
double p_of_fit(const Findings &findings, const Fit &fit);
/// Interval (95 %) of the amplitude of one effect of a fit, in scales from the null value.
Interval amplitude_interval(const Workbench &bench, const Findings &findings, const Fit &fit,
                            std::size_t member);
/// Amplitudes of the chosen effects with intervals.
Table describe_amplitudes(const Workbench &bench, const Findings &findings);

/// Best values of the nuisances beside a fit, in prior deviations from their null values.
/// @param remainder that the fit leaves, in coordinates of the misfit
/// @param leverage of the fit
Eigen::VectorXd nuisance_estimates(const Workbench &bench, const Eigen::VectorXd &remainder,
                                   double leverage);
/// Their covariance, which is the unit matrix where the data say nothing of them.
Eigen::MatrixXd nuisance_covariance(const Workbench &bench, double leverage);

/// Means and spreads of base model, chosen model and data per cell.
Table describe_envelopes(const Workbench &bench, const Findings &findings);

/// Gap between data and model: root mean square deviation of the cells in standard deviations of
/// one run, less what noise explains.
struct Gap
{
  double value = 0., before_correction = 0.;
};
Gap gap(const Eigen::VectorXd &deviation, const Eigen::VectorXd &noise_variance);

} // namespace eunoe::discovery

#endif
