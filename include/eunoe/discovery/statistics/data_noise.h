#ifndef eunoe_discovery_statistics_data_noise_h
#define eunoe_discovery_statistics_data_noise_h

#include <eunoe/discovery/statistics/modes.h>

namespace eunoe::discovery {

/// What is known of the measured means' noise. Repeats of a measurement differ as runs do, with
/// the same chaos, and by the instrument, independently from cell to cell. The measured standard
/// deviations, from few repeats each, say how much of the latter there is: per observable, drawn
/// towards the mean over all observables.
struct DataNoise
{
  Eigen::MatrixXd modes;         ///< covariance of the means of all repeats
  Eigen::VectorXd cell_variance; ///< of the means, in squared units of a cell's chaos
  Eigen::VectorXd ratio;         ///< per cell: variance of a repeat over that of a run
};

/// What was measured beside the means.
struct Repeats
{
  Eigen::VectorXd deviation; ///< of a single repeat, in units of the cell's chaos
  Eigen::VectorXd number;    ///< of repeats
};

/// @param chaos covariance of one run's modes
/// @param cell_chaos variance of each cell in one run, in squared units of modes.deviations()
DataNoise estimate_data_noise(const Modes &modes, const Eigen::MatrixXd &chaos,
                              const Eigen::VectorXd &cell_chaos, const Repeats &repeats);

} // namespace eunoe::discovery

#endif
