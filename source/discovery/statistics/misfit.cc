#include <eunoe/discovery/statistics/misfit.h>

#include <cmath>

namespace eunoe::discovery {

Misfit::Misfit(const Eigen::MatrixXd &replicate_covariance, const Eigen::MatrixXd &other)
{
  const Eigen::LLT<Eigen::MatrixXd> factor(replicate_covariance);
  const auto lower = factor.matrixL();
  const Eigen::MatrixXd half = lower.solve(other);
  Eigen::MatrixXd white = lower.solve(half.transpose());
  white = 0.5 * (white + white.transpose().eval());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(white);
  other_variance = eigen.eigenvalues().cwiseMax(0.);
  transform = eigen.eigenvectors().transpose() *
              lower
                  .solve(Eigen::MatrixXd::Identity(replicate_covariance.rows(),
                                                   replicate_covariance.cols()))
                  .eval();
}

double Misfit::deviance(const double distance, const double log_determinant) const
{
  const double nu = tail.degrees_of_freedom, n = static_cast<double>(size());
  return (nu + n) * std::log1p(distance / (nu * tail.inflation)) + log_determinant;
}

} // namespace eunoe::discovery
