#ifndef eunoe_discovery_stages_held_out_h
#define eunoe_discovery_stages_held_out_h

#include <eunoe/discovery/stages/models.h>

namespace eunoe::discovery {

/// Held-out data, and replicates of the base model and of the chosen one. Values are in units of
/// the deviation between replicates at each data point.
struct HeldOut
{
  std::vector<MeasuredPoint> points;
  Eigen::VectorXd data, deviation, repeats, scale;
  Eigen::MatrixXd before,
      after; ///< replicates x data points; `after` has no rows without a chosen model
  Eigen::MatrixXd nuisances;     ///< data points x nuisances: change by one prior deviation
  double nuisance_variance = 0.; ///< of each such change, in units of a replicate's
};

/// Runs the held-out experiments: the base model, the model with the chosen amplitudes if there are
/// any, and the base model with each nuisance on both sides of its null value. The result has no
/// data points if fewer than three runs of the base model reached their end, or if nothing varies.
/// @param times multiplies the numbers of runs in the study's options; runs of an earlier call
/// count
HeldOut make_held_out(StudyState &study, const Amplitudes &chosen, unsigned int times);

/// Largest number of runs of make_held_out, once.
std::uint64_t held_out_runs(const MeasuredData &data, const StudyOptions &options,
                            std::size_t n_nuisances);

/// Prediction of a model at the held-out data points: the mean of its replicates, with the
/// nuisances at their estimates from the data of the fit. Its covariance is the sum of the outer
/// products of the columns of `uncertainty`, and of the noise of the replicates.
struct Prediction
{
  bool is_of_base = true;
  Eigen::MatrixXd runs;
  Eigen::VectorXd mean;
  Eigen::MatrixXd uncertainty; ///< data points x (nuisances + 1), the last from amplitudes
  double leverage = 0.; ///< variance from the noise of replicates, in units of one replicate's
};

/// @param runs replicates at this fit
/// @param amplitude_error relative standard error of the fitted amplitudes
Prediction predict(const StudyState &study, const HeldOut &held_out, const Eigen::MatrixXd &runs,
                   const Fit &fit, double amplitude_error);

/// p-value of a model on held-out data: a nested bootstrap of the squared Mahalanobis distance.
/// Each draw has replicates and repeats of its own, from which all covariances are estimated.
double p_of_held_out(const HeldOut &held_out, const Prediction &prediction, std::uint32_t seed);

/// Variance of each data point's deviation between data and prediction.
Eigen::VectorXd noise_variance(const HeldOut &held_out, const Prediction &prediction);

} // namespace eunoe::discovery

#endif
