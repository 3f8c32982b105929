#ifndef eunoe_discovery_statistics_misfit_h
#define eunoe_discovery_statistics_misfit_h

#include <Eigen/Dense>

namespace eunoe::discovery {

/// Mahalanobis distance and likelihood of deviations between data and a model. The variance of the
/// model's prediction is a multiple h, its leverage, of the covariance C of one replicate; all else
/// (the data's noise, the nuisances) has covariance E. So deviations have covariance E + h C. In
/// coordinates that make both diagonal, each evaluation costs as many operations as there are
/// modes.
class Misfit
{
public:
  Misfit() = default;

  /// @param replicate_covariance C
  /// @param other E
  Misfit(const Eigen::MatrixXd &replicate_covariance, const Eigen::MatrixXd &other);

  /// Coordinates of deviations (a column each) in which C is the unit matrix and E diagonal.
  Eigen::MatrixXd coordinates(const Eigen::MatrixXd &modes) const { return transform * modes; }

  const Eigen::MatrixXd &matrix() const { return transform; }

  Eigen::Index size() const { return other_variance.size(); }

  /// Variance of each coordinate, E + h C.
  Eigen::VectorXd variance(double h) const { return (other_variance.array() + h).matrix(); }

  /// Squared Mahalanobis distance of a deviation in coordinates.
  double distance(const Eigen::VectorXd &deviation, double h) const
  {
    return (deviation.array().square() / (other_variance.array() + h)).sum();
  }
  double log_determinant(double h) const { return (other_variance.array() + h).log().sum(); }

  /// With an estimated covariance, squared distances follow inflation * n * F(n, degrees of
  /// freedom) instead of chi-square.
  struct Tail
  {
    double degrees_of_freedom = 1e9, inflation = 1.;
  };
  Tail tail;

  /// -2 log likelihood, up to a constant, of a distance and a log determinant.
  double deviance(double distance, double log_determinant) const;

private:
  Eigen::MatrixXd transform;
  Eigen::VectorXd other_variance;
};

} // namespace eunoe::discovery

#endif
