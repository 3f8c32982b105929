#ifndef eunoe_discovery_statistics_gaussian_process_h
#define eunoe_discovery_statistics_gaussian_process_h

#include <Eigen/Dense>
#include <vector>

namespace eunoe::discovery {

/// Outcome of the base model as a linear function of the nuisances: coefficients (a row for the
/// mean, one for each nuisance) and their covariance in units of that of one replicate.
struct LinearBase
{
  Eigen::MatrixXd coefficients, covariance;
};

/// What some runs say of the base model: the normal equations of a regression, to which those of
/// other runs can be added.
struct BaseInformation
{
  Eigen::MatrixXd precision; ///< terms x terms
  Eigen::MatrixXd weighted;  ///< terms x values: precision times coefficients

  LinearBase solve() const;
};

/// Gaussian process of the outcome of one experiment along the amplitude of one effect. The change
/// from the base model is linear plus a Brownian motion, both in |u|^p, so that the response may be
/// steep near zero and has no preferred shape beyond; it may depend on the nuisances. Values are
/// whitened: the noise of one run has unit variance in each, and all share the kernel.
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

  /// Numbers of the kernel, chosen by the marginal likelihood of the points.
  struct Kernel
  {
    double power = 1., roughness = 0., variance = 0., interaction = 0.;
    double at(double a, double b) const;
  };

  /// @param points with the effect; none: the effect changes nothing
  GaussianProcess(std::vector<Point> points, const LinearBase &base);

  struct Prediction
  {
    Eigen::VectorXd mean;     ///< at the nuisances' null values
    Eigen::MatrixXd gradient; ///< change by one prior deviation of each nuisance, in columns
    /// Variance of the prediction, that of the gradient along typical nuisances included, in units
    /// of one replicate's.
    double leverage = 0.;
  };
  Prediction predict(double amplitude) const;

  /// What the points say of the base model, as far as the effect may be unknown between them.
  BaseInformation about_base() const;
  /// Replaces what other runs say of the base model. The kernel stays.
  void set_base(const LinearBase &others);

  const std::vector<Point> &points() const { return all; }
  const Kernel &kernel() const { return best; }

private:
  Eigen::MatrixXd effect_covariance(const Kernel &kernel) const;
  void choose_kernel();

  std::vector<Point> all;
  LinearBase base;
  Eigen::MatrixXd terms, values; ///< a row for each point: terms of the base model, means
  Kernel best;
  Eigen::LLT<Eigen::MatrixXd> solver;
  Eigen::MatrixXd weights; ///< covariance^-1 residuals
};

} // namespace eunoe::discovery

#endif
