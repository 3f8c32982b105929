#ifndef eunoe_discovery_statistics_data_noise_h
#define eunoe_discovery_statistics_data_noise_h

#include <eunoe/discovery/statistics/modes.h>
#include <eunoe/discovery/statistics/random_stream.h>

#include <Eigen/Dense>
#include <vector>

namespace eunoe::discovery {

/// Standard deviations and numbers of the repeats of a measurement.
struct Repeats
{
  Eigen::VectorXd deviation; ///< of a single repeat, in units of modes.deviations()
  Eigen::VectorXd number;    ///< of repeats
};

/// Variance that the instrument adds to that between replicates, in units of the latter: its
/// posterior, as few repeats tell it. Noise that is taken for too small counts most: what hardly
/// varies between runs, such as the ratio of two observables, would seem to deviate by far.
class ExcessVariance
{
public:
  /// @param ratio of the variances of repeats and of replicates
  /// @param degrees_of_freedom of the ratio; 0: it is known
  /// @param expected mean of the prior
  ExcessVariance(double ratio, double degrees_of_freedom, double expected);

  double mean() const { return average; }
  double draw(RandomStream &random) const;

private:
  std::vector<double> values, below; ///< and the probability of all up to each
  double average = 0.;
};

/// The noise of the instrument in each of the modes' groups, that is in each observable.
/// @param replicate_covariance of the modes of one replicate
std::vector<ExcessVariance> excess_variances(const Modes &modes,
                                             const Eigen::MatrixXd &replicate_covariance,
                                             const Repeats &repeats);

} // namespace eunoe::discovery

#endif
