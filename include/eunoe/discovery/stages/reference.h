#ifndef eunoe_discovery_stages_reference_h
#define eunoe_discovery_stages_reference_h

#include <eunoe/discovery/stages/workbench.h>

namespace eunoe::discovery {

/// What is looked at to tell whether something is missing.
struct Evidence
{
  double distance = 0.; ///< squared Mahalanobis distance of all modes
  double cell = 0.;     ///< largest deviation of a cell, in standard errors
  double gain = 0.;     ///< largest fall of deviance that one effect brings, once they are known
};

/// Evidence in studies in which nothing is missing: a nested bootstrap. In each draw the replicates
/// of the base model and the repeats of the measurement are drawn anew, and covariance, noise and
/// statistics are estimated from them as from the real ones, so that thresholds know how little
/// few runs tell of a covariance.
struct Reference
{
  std::vector<Evidence> draws;
  Misfit::Tail tail;           ///< of distance
  double direction_limit = 4.; ///< fall of deviance along one direction, exceeded by `level`

  double p_distance(double distance, double share_of_modes = 1.) const;
  double p_cell(double deviation) const;
  double p_gain(double gain) const;
  /// Of the least of the three (of the first two without effects), which is itself calibrated.
  double p_joint(const Evidence &evidence, bool with_gain) const;
  /// The smallest p that so many draws can show: what they never reach may be far less likely.
  double least_p() const { return chi_square ? 0. : 1. / (1. + static_cast<double>(draws.size())); }
  /// The value that the draws exceed with this probability.
  double gain_limit(double probability) const;

  // Without a bootstrap, for comparison: chi-square and Bonferroni.
  bool chi_square = false;
  double n_modes = 0., n_cells = 0., n_effects = 0.;
};

/// Standard error of each cell's deviation between data and base model, in units of its chaos.
Eigen::VectorXd cell_errors(const Workbench &bench);

/// Evidence of the real data against the base model; the gain only if `responses` are given.
Evidence evidence_against_base(const Workbench &bench, const std::vector<Response> &responses);

/// @param responses of single effects in modes (not in coordinates of the misfit); none before the
///   stage screen
Reference make_reference(const Workbench &bench, const std::vector<Response> &responses);

} // namespace eunoe::discovery

#endif
