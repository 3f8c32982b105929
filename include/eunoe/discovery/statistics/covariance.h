#ifndef eunoe_discovery_statistics_covariance_h
#define eunoe_discovery_statistics_covariance_h

#include <Eigen/Dense>
#include <vector>

namespace eunoe::discovery {

/// Covariance of one run, estimated from replicates.
struct Covariance
{
  Eigen::MatrixXd matrix;
  /// The same with hardly any shrinkage, for bootstraps: draws that were rounder than nature would
  /// make false alarms.
  Eigen::MatrixXd unshrunk;
  double shrinkage = 0.; ///< weight of the target: correlations that are zero
};

/// Estimate with correlations shrunk towards zero by the share that minimises the expected error
/// (Ledoit and Wolf 2004; Schaefer and Strimmer 2005, Statist. Appl. Genet. Mol. Biol. 4, 32).
/// @param deviations runs x modes, from their means
/// @param degrees_of_freedom runs less the means that were subtracted
/// @param block columns with different numbers are uncorrelated, as they come from other runs
Covariance shrunk_covariance(const Eigen::MatrixXd &deviations, double degrees_of_freedom,
                             const std::vector<int> &block);

/// Rows less their mean.
Eigen::MatrixXd centred(const Eigen::MatrixXd &rows);

} // namespace eunoe::discovery

#endif
