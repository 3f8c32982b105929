#ifndef eunoe_discovery_stages_models_h
#define eunoe_discovery_stages_models_h

#include <eunoe/discovery/stages/study_state.h>

namespace eunoe::discovery {

/// A set of effects at its best amplitudes.
struct Fit
{
  EffectSet effects;
  Eigen::VectorXd position;  ///< amplitudes less their null values, over the factors' scales
  double deviance = 0.;      ///< -2 log likelihood, up to a constant
  double distance = 0.;      ///< squared Mahalanobis distance between data and model
  double leverage = 0.;      ///< variance of the prediction, in units of one replicate's
  Eigen::VectorXd remainder; ///< data less prediction, in coordinates of the misfit
};

/// Deviance of a set of effects as a function of their amplitudes. The emulator comes from few
/// runs: its predicted change is shrunk by the share that noise explains (James and Stein), and the
/// variance that stays widens the misfit.
class Objective
{
public:
  /// @param data in coordinates of the misfit
  Objective(const Misfit &misfit, const Emulator &emulator, const Eigen::VectorXd &data)
      : misfit(misfit), emulator(emulator), data(data)
  {
  }

  Fit at(const Eigen::VectorXd &position) const;

  /// Predicted change from the base model, shrunk by its share of noise.
  Eigen::VectorXd change(const Eigen::VectorXd &position, double &leverage) const;

private:
  const Misfit &misfit;
  const Emulator &emulator;
  const Eigen::VectorXd &data;
};

/// Range of each effect's position: what physics allows and the runs so far cover.
struct Bounds
{
  Eigen::VectorXd lower, upper;
};
Bounds bounds(const StudyState &study, const EffectSet &set, const Emulator &emulator);

/// Best amplitudes within bounds, by descent along one effect after the other.
Fit minimise(const Objective &objective, const Bounds &bounds);

/// The data in coordinates of the misfit.
Eigen::VectorXd data_coordinates(const StudyState &study);

/// Best fit of a set of effects to the data; of the base model if the set is empty.
Fit fit_model(const StudyState &study, const EffectSet &set);

/// Amplitudes of one effect of a fitted set whose deviance, with the others at their best, stays
/// within `allowed` of the best.
struct Interval
{
  double lower, upper;         ///< in scales from the null value
  bool open_below, open_above; ///< whether the interval ends at the limit of the search
};
Interval profile_interval(const StudyState &study, const Fit &fit, std::size_t member,
                          double allowed);

} // namespace eunoe::discovery

#endif
