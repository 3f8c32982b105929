#ifndef eunoe_discovery_inference_likelihood_h
#define eunoe_discovery_inference_likelihood_h

#include <eunoe/discovery/inference/target.h>
#include <eunoe/discovery/statistics/logarithms.h>

namespace eunoe::discovery {

/// Likelihood of data for fixed effects, with all that does not depend on the data prepared: a
/// normal distribution for each level of the instrument's noise.
struct Hypothesis
{
  Target::Prediction prediction;
  Eigen::MatrixXd inverse; ///< of the variances, coordinates x levels
  /// What nuisances explain of a deviation, coordinates x nuisances for each level in turn.
  Eigen::MatrixXd half;
  Eigen::VectorXd constant; ///< of each level

  /// Squared Mahalanobis distances of deviations from the mean, levels x columns.
  Eigen::MatrixXd distances(const Eigen::Ref<const Eigen::MatrixXd> &deviations) const;
};

/// Likelihood of data, nuisances and the instrument's noise integrated. The covariance is
/// estimated, so it is a t-distribution (Sellentin and Heavens 2016, MNRAS 456, L132).
class Likelihood
{
public:
  explicit Likelihood(const Target &target);

  Hypothesis prepare(const Target::Prediction &prediction) const
  {
    return prepare(prediction, aim.variances(prediction));
  }
  /// @param variances coordinates x levels: with the mean variance instead of those of the
  /// instrument's noise it is a fifth of the work
  static Hypothesis prepare(const Target::Prediction &prediction, const Eigen::MatrixXd &variances);
  /// Log-likelihoods of data in columns; the instrument's noise is integrated.
  Eigen::ArrayXd log_likelihoods(const Hypothesis &hypothesis,
                                 const Eigen::Ref<const Eigen::MatrixXd> &data) const
  {
    return log_likelihoods_about(hypothesis, hypothesis.prediction.mean, data);
  }
  double log_likelihood(const Hypothesis &hypothesis, const Eigen::VectorXd &data) const
  {
    return log_likelihoods(hypothesis, data)(0);
  }
  /// With another mean than the hypothesis has.
  Eigen::ArrayXd log_likelihoods_about(const Hypothesis &hypothesis, const Eigen::VectorXd &mean,
                                       const Eigen::Ref<const Eigen::MatrixXd> &data) const;
  /// Inverse of the variances, at the levels of noise that the target's data speak for.
  Eigen::VectorXd inverse_variance(const Hypothesis &hypothesis) const;

  /// Log-likelihood of the target's data that is to be expected once runs have left no more error
  /// than that of the base model, if the hypothesis is true: its mean moves towards the data as far
  /// as its error allows.
  /// @param deviations by which the likelihood may exceed what is expected, as the mean could come
  /// to lie nearer to the data by chance
  double log_optimistic(const Hypothesis &hypothesis, double deviations = 0.) const;

  const Target &target() const { return aim; }
  const Hypothesis &nothing() const { return base; }
  /// Of the mean, from that of the base model.
  Eigen::VectorXd change(const Target::Prediction &with) const
  {
    return with.mean - base.prediction.mean;
  }
  double degrees_of_freedom() const { return dof; } ///< of the t-distribution

protected:
  /// @param constants of normal distributions, one for each row
  /// @param distances squared Mahalanobis distances, a column for each data
  Eigen::ArrayXXd log_t(const Eigen::ArrayXd &constants, const Eigen::ArrayXXd &distances) const;

private:
  Eigen::ArrayXXd log_of_levels(const Hypothesis &hypothesis, const Eigen::VectorXd &mean,
                                const Eigen::Ref<const Eigen::MatrixXd> &data) const;

  const Target &aim;
  const double dof;
  const Hypothesis base;
};

} // namespace eunoe::discovery

#endif
