#include <eunoe/discovery/statistics/covariance.h>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

Eigen::MatrixXd centred(const Eigen::MatrixXd &rows)
{
  return rows.rowwise() - rows.colwise().mean();
}

Covariance shrunk_covariance(const Eigen::MatrixXd &deviations, const double degrees_of_freedom,
                             const std::vector<int> &block)
{
  const Eigen::Index n = deviations.cols(), runs = deviations.rows();
  const double dof = std::max(1., degrees_of_freedom);
  const Eigen::VectorXd variance = deviations.colwise().squaredNorm().transpose() / dof;
  const double floor = 1e-12 * std::max(variance.maxCoeff(), 1e-300);
  const Eigen::VectorXd sigma = variance.cwiseMax(floor).cwiseSqrt();
  const Eigen::MatrixXd z = deviations * sigma.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd correlation = z.transpose() * z / dof;

  // Sum of the variances of all correlations, and of their squares, over i != j of one block.
  double squares = 0., fourth = 0., products = 0.;
  const int n_blocks = block.empty() ? 0 : *std::max_element(block.begin(), block.end()) + 1;
  for (Eigen::Index k = 0; k < runs; ++k) {
    std::vector<double> norm(static_cast<std::size_t>(n_blocks), 0.);
    for (Eigen::Index i = 0; i < n; ++i) {
      const double square = z(k, i) * z(k, i);
      norm[static_cast<std::size_t>(block[static_cast<std::size_t>(i)])] += square;
      fourth -= square * square;
    }
    for (const double sum : norm)
      fourth += sum * sum;
  }
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      if (i != j && block[static_cast<std::size_t>(i)] == block[static_cast<std::size_t>(j)]) {
        squares += correlation(i, j) * correlation(i, j);
        products += std::pow(correlation(i, j) * dof, 2) / static_cast<double>(runs);
      }
  Covariance result;
  const double variance_sum = (fourth - products) * static_cast<double>(runs) / std::pow(dof, 3);
  result.shrinkage = squares > 0. ? std::clamp(variance_sum / squares, 0., 1.) : 1.;
  result.matrix = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      if (i == j)
        result.matrix(i, i) = sigma(i) * sigma(i);
      else if (block[static_cast<std::size_t>(i)] == block[static_cast<std::size_t>(j)])
        result.matrix(i, j) = (1. - result.shrinkage) * correlation(i, j) * sigma(i) * sigma(j);
  // With correlations unshrunk and few runs the matrix could be singular.
  const double least = 0.02;
  if (result.shrinkage < least)
    result.matrix.diagonal() *= 1. + least;
  return result;
}

} // namespace eunoe::discovery
