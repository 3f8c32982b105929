#include <eunoe/discovery/statistics/logarithms.h>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

double log_sum(const std::vector<double> &logarithms)
{
  const double largest = *std::max_element(logarithms.begin(), logarithms.end());
  double sum = 0.;
  for (const double value : logarithms)
    sum += std::exp(value - largest);
  return largest + std::log(sum);
}

Eigen::ArrayXd log_sums(const Eigen::ArrayXXd &logarithms)
{
  const Eigen::ArrayXd largest = logarithms.colwise().maxCoeff().transpose();
  return largest +
         (logarithms.rowwise() - largest.transpose()).exp().colwise().sum().transpose().log();
}

std::vector<double> shares_of(std::vector<double> logarithms)
{
  const double total = logarithms.empty() ? 0. : log_sum(logarithms);
  for (double &value : logarithms)
    value = std::exp(value - total);
  return logarithms;
}

} // namespace eunoe::discovery
