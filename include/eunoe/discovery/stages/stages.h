#ifndef eunoe_discovery_stages_stages_h
#define eunoe_discovery_stages_stages_h

#include <eunoe/discovery/stages/null_distribution.h>
#include <eunoe/discovery/stages/posterior.h>

#include <nlohmann/json.hpp>

namespace eunoe::discovery {

/// What the stages have found so far.
struct Findings
{
  DecisionRule decision;

  // detect
  NullDistribution base_null_distribution;
  TestStatistics statistics; ///< of the base model; with the gain once there are fingerprints
  double p_global = 1.;

  // screen
  NullDistribution null_distribution;
  double p_detected = 1.;  ///< of all statistics together
  bool p_is_bound = false; ///< no draw of the bootstrap reaches the statistics: p is smaller yet
  bool detected = false;

  // confirm, fit, iterate
  Posterior posterior;
  ScoredModel chosen; ///< the chosen model; without effects if nothing was detected
  double p_fit = 1.;  ///< of the chosen model's fit to the data

  Verdict verdict = Verdict::none;
  std::vector<ScoredModel>
      tie; ///< sets of effects that the data do not tell apart, the likeliest first
  std::vector<double> confidence; ///< of each effect
  double off_catalogue = 0.;      ///< confidence in "something else"
  std::vector<EffectSet> refuted; ///< sets of the tie that the held-out data refute
  bool withdrawn = false;
};

using Table = nlohmann::ordered_json;

/// Each stage makes its runs, adds to the findings, and returns its table (doc/discovery_json.md).
Table stage_null(StudyState &study);
Table stage_detect(StudyState &study, Findings &findings);
Table stage_screen(StudyState &study, Findings &findings);
Table stage_confirm(StudyState &study, Findings &findings);
Table stage_fit(StudyState &study, Findings &findings);
Table stage_iterate(StudyState &study, Findings &findings);
Table stage_validate(StudyState &study, Findings &findings);

/// Runs the base model, and the base model with each nuisance on either side of its null value,
/// until there are this many replicates.
void run_base_design(StudyState &study, unsigned int base, unsigned int nuisance);

/// Estimates the covariance of replicates, the data's noise and the misfit anew from all runs so
/// far.
void estimate_replicate_covariance(StudyState &study);
/// The same, and the changes by nuisances.
void estimate_noise(StudyState &study);
/// Makes the null distribution without emulators, and takes the misfit's tail from it.
void make_base_null_distribution(StudyState &study, Findings &findings);

/// The sets of effects that may become the likeliest once more runs are there, the most promising
/// first. The evidence of a set is small where few runs support its emulator, and the stage confirm
/// adds such runs. So sets are ranked here without that loss of evidence, and sets far below the
/// amplitudes that were run are ranked by their best case. Probabilities are relative to these sets
/// alone, without "off catalogue".
std::vector<ScoredModel> promising_models(const StudyState &study, const Posterior &posterior,
                                          const DecisionRule &decision);

/// Sets verdict, tie set and confidences from the posterior.
void decide(Findings &findings);
/// Computes the confidences alone, after sets of effects have been refuted.
void compute_confidence(Findings &findings);

/// Sets of effects as a table: effects, probability, amplitudes.
Table describe_models(const StudyState &study, const std::vector<ScoredModel> &models);

/// Measurements that would tell the sets of a tie apart, the best first.
Table separating_measurements(StudyState &study, const std::vector<ScoredModel> &tie);

/// Residuals of the closest model: at which data points, and which fingerprints they resemble.
Table describe_remainder(const StudyState &study, const Findings &findings);

/// p-value of a fit: the probability of data as far from the model as these if the model is true.
double p_of_fit(const Findings &findings, const Fit &fit);
/// Interval (95 %) of the amplitude of one effect of a fit, as a position (Fit::position).
Interval amplitude_interval(const StudyState &study, const Findings &findings, const Fit &fit,
                            std::size_t member);
/// Amplitudes of the chosen effects with intervals.
Table describe_amplitudes(const StudyState &study, const Findings &findings);

/// Estimates of the nuisances given a fit, in prior deviations from their null values.
/// @param remainder residual of the fit, in coordinates of the misfit
/// @param leverage of the fit
Eigen::VectorXd nuisance_estimates(const StudyState &study, const Eigen::VectorXd &remainder,
                                   double leverage);
/// Posterior covariance of the nuisances; the unit matrix where the data say nothing about them.
Eigen::MatrixXd nuisance_covariance(const StudyState &study, double leverage);

/// Means and standard deviations of base model, chosen model and data at each data point.
Table describe_envelopes(const StudyState &study, const Findings &findings);

/// Discrepancy between data and model, the "gap" of the tables: root mean square deviation over the
/// data points, in standard deviations of one replicate, less what noise explains.
struct Discrepancy
{
  double value = 0., before_correction = 0.;
};
Discrepancy discrepancy(const Eigen::VectorXd &deviation, const Eigen::VectorXd &noise_variance);

} // namespace eunoe::discovery

#endif
