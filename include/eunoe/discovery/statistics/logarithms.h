#ifndef eunoe_discovery_statistics_logarithms_h
#define eunoe_discovery_statistics_logarithms_h

#include <Eigen/Dense>
#include <vector>

namespace eunoe::discovery {

/// log(sum of exp).
double log_sum(const std::vector<double> &logarithms);
/// The same of each column.
Eigen::ArrayXd log_sums(const Eigen::ArrayXXd &logarithms);
/// Each exponential over their sum.
std::vector<double> shares_of(std::vector<double> logarithms);

} // namespace eunoe::discovery

#endif
