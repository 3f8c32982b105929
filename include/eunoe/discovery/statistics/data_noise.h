#ifndef eunoe_discovery_statistics_data_noise_h
#define eunoe_discovery_statistics_data_noise_h

#include <eunoe/discovery/statistics/modes.h>
#include <eunoe/discovery/statistics/random_stream.h>

#include <Eigen/Dense>
#include <vector>

namespace eunoe::discovery {

/// Variance that the instrument adds to that between replicates, in units of the latter, in one
/// observable: its posterior, as few repeats tell it.
class ExcessVariance
{
public:
  /// @param ratio of the variances of repeats and of replicates
  /// @param degrees_of_freedom of the ratio; 0: it is known
  /// @param expected mean of the prior
  ExcessVariance(double ratio, double degrees_of_freedom, double expected);

  double mean() const { return average; }
  double draw(RandomStream &random) const;
  /// Log of the probability of the ratio, up to a constant that does not depend on the prior.
  double log_evidence() const { return log_of_all; }

private:
  std::vector<double> values, below; ///< and the probability of all up to each
  double average = 0., log_of_all = 0.;
};

/// The noise of the instrument in each observable of an experiment. All observables tell of a
/// common level of the noise, about which each has its own. Few repeats leave the level uncertain
/// by far more than its typical size, so that nothing should rest on a single value of it: it is
/// given by quantiles of its posterior, for integration.
class InstrumentNoise
{
public:
  /// @param modes in groups, one for each observable
  /// @param replicate_covariance of the modes of one replicate
  /// @param deviation of a single repeat at each data point, in units of modes.deviations()
  /// @param repeats their number
  InstrumentNoise(const Modes &modes, const Eigen::MatrixXd &replicate_covariance,
                  const Eigen::VectorXd &deviation, const Eigen::VectorXd &repeats);

  /// Excess variance of each group if the level is at this quantile.
  const std::vector<ExcessVariance> &at(double quantile) const;

private:
  std::vector<std::vector<ExcessVariance>> levels;
  std::vector<double> below; ///< probability of all levels up to each
};

} // namespace eunoe::discovery

#endif
