#ifndef eunoe_discovery_stages_held_out_h
#define eunoe_discovery_stages_held_out_h

#include <eunoe/discovery/stages/models.h>

namespace eunoe::discovery {

/// Held-out data beside runs of the base model and of the chosen one, in units of a cell's chaos.
struct HeldOut
{
  std::vector<MeasuredCell> cells;
  Eigen::VectorXd data, deviation, repeats, scale;
  Eigen::MatrixXd before, after; ///< runs x cells; `after` has no rows without a chosen model
  Eigen::MatrixXd nuisances;     ///< cells x nuisances: change by one prior deviation
  double nuisance_variance = 0.; ///< of each such change, in units of one run's chaos
};

/// Makes the runs of the held-out experiments: of the base model, of the model with these
/// amplitudes, unless there are none, and of the base model with each nuisance on both sides. No
/// cells if fewer than three runs of the base model came to their end, or if nothing varies.
/// @param times how many times the runs that the study's options say; those of an earlier call
///   count
HeldOut make_held_out(Workbench &bench, const Amplitudes &chosen, unsigned int times);

/// Number of runs that this takes at most, once.
std::uint64_t held_out_runs(const MeasuredData &data, const StudyOptions &options,
                            std::size_t n_nuisances);

/// What a model says of the held-out cells: the mean of its runs, with the nuisances where the data
/// of the fit have them beside it; and what is not known of that, beside the noise of the runs, as
/// columns whose outer products add up to its covariance.
struct Prediction
{
  bool is_of_base = true;
  Eigen::MatrixXd runs;
  Eigen::VectorXd mean;
  Eigen::MatrixXd doubt; ///< cells x (nuisances + 1): of nuisances, and of the amplitudes
  double leverage = 0.;  ///< variance by noise of runs, in units of one run's chaos
};

/// @param runs of this fit
/// @param amplitude_error relative standard error of the fitted amplitudes
Prediction predict(const Workbench &bench, const HeldOut &held_out, const Eigen::MatrixXd &runs,
                   const Fit &fit, double amplitude_error);

/// Probability that held-out data are as far from what a model says as these, were it true: a
/// nested bootstrap of the squared Mahalanobis distance, in whose draws runs and repeats are drawn
/// anew and all covariances are estimated from them.
double p_of_held_out(const HeldOut &held_out, const Prediction &prediction, std::uint32_t seed);

/// Variance of each cell's deviation between data and prediction.
Eigen::VectorXd noise_variance(const HeldOut &held_out, const Prediction &prediction);

} // namespace eunoe::discovery

#endif
