#ifndef eunoe_discovery_statistics_covariance_h
#define eunoe_discovery_statistics_covariance_h

#include <Eigen/Dense>

namespace eunoe::discovery {

/// Covariance of one replicate, estimated from several.
struct Covariance
{
  Eigen::MatrixXd matrix;
  double shrinkage = 0.; ///< weight of the target, in which all correlations are zero
};

/// Estimate with correlations shrunk towards zero by the share that minimises the expected error
/// (Ledoit and Wolf 2004; Schaefer and Strimmer 2005, Statist. Appl. Genet. Mol. Biol. 4, 32).
/// @param deviations from the means, replicates x modes, in units of the deviation that is believed
/// of modes that do not vary
/// @param degrees_of_freedom number of replicates less the number of means that were subtracted
Covariance shrunk_covariance(const Eigen::MatrixXd &deviations, double degrees_of_freedom);

/// Rows less their mean.
Eigen::MatrixXd centred(const Eigen::MatrixXd &rows);

/// Standard deviation of each column.
Eigen::VectorXd deviations(const Eigen::MatrixXd &rows);

/// Half the logarithm of the determinant of the matrix that was factorised.
double half_log_determinant(const Eigen::LLT<Eigen::MatrixXd> &llt);

} // namespace eunoe::discovery

#endif
