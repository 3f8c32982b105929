#ifndef eunoe_discovery_statistics_data_noise_h
#define eunoe_discovery_statistics_data_noise_h

#include <eunoe/discovery/statistics/modes.h>

namespace eunoe::discovery {

/// Noise of the measured means. Repeats of a measurement differ as replicates of a simulation do,
/// with the same covariance, and by the noise of the instrument, which is independent at each data
/// point. The instrument's share is estimated from the measured standard deviations: for each
/// observable, shrunk towards the mean over all observables, because each comes from few repeats.
struct DataNoise
{
  Eigen::MatrixXd modes;          ///< covariance of the means of all repeats
  Eigen::VectorXd point_variance; ///< of the means, in units of modes.deviations() squared
  Eigen::VectorXd ratio;          ///< per data point: variance of a repeat over that of a replicate
};

/// Standard deviations and numbers of the repeats of a measurement.
struct Repeats
{
  Eigen::VectorXd deviation; ///< of a single repeat, in units of modes.deviations()
  Eigen::VectorXd number;    ///< of repeats
};

/// @param replicate_covariance of the modes of one replicate
/// @param replicate_variance of each data point, in units of modes.deviations() squared
DataNoise estimate_data_noise(const Modes &modes, const Eigen::MatrixXd &replicate_covariance,
                              const Eigen::VectorXd &replicate_variance, const Repeats &repeats);

} // namespace eunoe::discovery

#endif
