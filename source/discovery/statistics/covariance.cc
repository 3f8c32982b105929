#include <eunoe/discovery/statistics/covariance.h>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

Eigen::MatrixXd centred(const Eigen::MatrixXd &rows)
{
  return rows.rowwise() - rows.colwise().mean();
}

Eigen::VectorXd deviations(const Eigen::MatrixXd &rows)
{
  return (centred(rows).colwise().squaredNorm().transpose() / static_cast<double>(rows.rows() - 1))
      .cwiseSqrt();
}

double half_log_determinant(const Eigen::LLT<Eigen::MatrixXd> &llt)
{
  return llt.matrixLLT().diagonal().array().log().sum();
}

Covariance shrunk_covariance(const Eigen::MatrixXd &deviations, const double degrees_of_freedom)
{
  const Eigen::Index n = deviations.cols();
  const auto runs = static_cast<double>(deviations.rows());
  const double dof = std::max(1., degrees_of_freedom);
  const Eigen::VectorXd variance = deviations.colwise().squaredNorm().transpose() / dof;
  constexpr double rounding = 1e-12;
  const Eigen::VectorXd sigma = (variance.array() > rounding).select(variance, 1.).cwiseSqrt();
  const Eigen::MatrixXd z = deviations * sigma.cwiseInverse().asDiagonal();
  Eigen::MatrixXd correlation = z.transpose() * z / dof;
  correlation.diagonal().setZero();

  // Sums over i != j: of the squared correlations, and of the variances of all correlations.
  const double squares = correlation.squaredNorm(), products = squares * dof * dof / runs;
  const Eigen::MatrixXd z2 = z.cwiseAbs2();
  const double fourth = z2.rowwise().sum().squaredNorm() - z2.squaredNorm();
  Covariance result;
  const double variance_sum = (fourth - products) * runs / std::pow(dof, 3);
  result.shrinkage = squares > 0. ? std::clamp(variance_sum / squares, 0., 1.) : 1.;
  result.matrix = Eigen::MatrixXd::Identity(n, n) + (1. - result.shrinkage) * correlation;
  result.matrix = sigma.asDiagonal() * result.matrix * sigma.asDiagonal();
  // With correlations unshrunk and few runs the matrix could be singular.
  const double least = 0.02;
  if (result.shrinkage < least)
    result.matrix.diagonal() *= 1. + least;
  return result;
}

} // namespace eunoe::discovery
