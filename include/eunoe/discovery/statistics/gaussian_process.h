#ifndef eunoe_discovery_statistics_gaussian_process_h
#define eunoe_discovery_statistics_gaussian_process_h

#include <eunoe/discovery/tuned.h>

#include <Eigen/Dense>
#include <iterator>
#include <vector>

namespace eunoe::discovery {

/// Outcome of the base model as a linear function of the nuisances, a column for each value:
/// coefficients (a row for the mean, one for each nuisance) and the elements of their covariance,
/// in units of the variance of one replicate.
struct LinearBase
{
  Eigen::MatrixXd coefficients, covariance;
};

/// What some runs say of the base model: the normal equations of a regression, to which those of
/// other runs can be added.
struct BaseInformation
{
  Eigen::MatrixXd precision; ///< elements of the matrix x values
  Eigen::MatrixXd weighted;  ///< terms x values: precision times coefficients

  BaseInformation &operator+=(const BaseInformation &other)
  {
    precision += other.precision;
    weighted += other.weighted;
    return *this;
  }
  BaseInformation operator-(const BaseInformation &other) const
  {
    return {precision - other.precision, weighted - other.weighted};
  }
  LinearBase solve() const;
};

/// Gaussian process of the outcome of one experiment along the amplitude of one effect. The change
/// from the base model is linear plus a Brownian motion, both in |u|^p, so that the response may be
/// steep near zero and has no preferred shape beyond; it may depend on the nuisances. Values are
/// whitened: the noise of one run has unit variance in each. All have the same kernel up to its
/// variance. Most effects change few values by much and most hardly at all, so that each value has
/// a variance of its own, which is integrated: what the values' distribution over some variances
/// makes likely (empirical Bayes).
class GaussianProcess
{
public:
  /// Mean of the replicates at a design point.
  struct Point
  {
    double amplitude = 0.;     ///< less its null value, over the effect's scale
    Eigen::VectorXd nuisances; ///< in prior deviations
    Eigen::VectorXd mean;
    double variance = 1.; ///< of the mean
  };

  /// Shape of the kernel, chosen by the marginal likelihood of the points.
  struct Kernel
  {
    double power = 1., roughness = 0., interaction = 0.;
    double at(double a, double b) const; ///< for unit variance
  };

  /// @param points with the effect; none: the effect changes nothing
  /// @param base what other runs say of the base model
  /// @param variances that a value's kernel may have, from nothing to a strong effect
  GaussianProcess(std::vector<Point> points, const BaseInformation &base,
                  const std::vector<double> &variances = {std::begin(tuned::kernel::variances),
                                                          std::end(tuned::kernel::variances)});

  struct Prediction
  {
    Eigen::VectorXd mean;     ///< at the nuisances' null values
    Eigen::MatrixXd gradient; ///< change by one prior deviation of each nuisance, in columns
    /// Variance of the prediction, that of the gradient along typical nuisances included, in units
    /// of one replicate's.
    Eigen::VectorXd leverage;
  };
  Prediction predict(double amplitude) const;

  /// What the points say of the base model, as far as the effect may be unknown between them.
  BaseInformation about_base() const;
  /// Replaces what other runs say of the base model. Kernel and variances stay.
  void set_base(const BaseInformation &others);

  const Kernel &kernel() const { return best; }
  std::size_t n_points() const { return all.size(); }

private:
  /// The points in units of their noise, along axes on which they are independent whatever the
  /// kernel's variance is.
  struct Axes
  {
    Eigen::MatrixXd directions;
    Eigen::VectorXd eigenvalues; ///< of the kernel with unit variance
    Eigen::MatrixXd terms, values;
  };
  /// The regression for one variance of the kernel.
  struct Scale
  {
    double variance;
    Eigen::VectorXd weight;    ///< of each axis
    Eigen::VectorXd precision; ///< elements of the matrix, by these points, for every value
    Eigen::MatrixXd weighted;  ///< terms x values
    LinearBase base;           ///< by all runs
  };
  Axes axes_of(const Kernel &kernel) const;
  Eigen::MatrixXd log_likelihoods(const Axes &axes,
                                  const std::vector<Eigen::MatrixXd> &base_roots) const;
  void choose_kernel();

  std::vector<Point> all;
  LinearBase base;
  Eigen::VectorXd roots;         ///< of the inverse of each point's variance
  Eigen::MatrixXd terms, values; ///< a row for each point: terms of the base model, means
  Kernel best;
  Axes axes;
  std::vector<Scale> scales;
  Eigen::MatrixXd shares;
};

} // namespace eunoe::discovery

#endif
