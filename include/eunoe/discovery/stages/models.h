#ifndef eunoe_discovery_stages_models_h
#define eunoe_discovery_stages_models_h

#include <eunoe/discovery/stages/workbench.h>

namespace eunoe::discovery {

/// A set of effects at its best amplitudes.
struct Fit
{
  EffectSet effects;
  Eigen::VectorXd position;  ///< amplitudes in scales from the null values
  double deviance = 0.;      ///< -2 log likelihood, up to a constant
  double distance = 0.;      ///< squared Mahalanobis distance that is left
  double leverage = 0.;      ///< variance of the prediction in units of one run's chaos
  Eigen::VectorXd remainder; ///< data less prediction, in coordinates of the misfit
};

/// Deviance of a set of effects as a function of their amplitudes. Fingerprints come from few runs;
/// what they seem to say is drawn towards nothing by the share of it that noise explains (James
/// and Stein), and the doubt that stays widens the misfit.
class Objective
{
public:
  /// @param data in coordinates of the misfit
  Objective(const Misfit &misfit, const Response &response, const Eigen::VectorXd &data)
      : misfit(misfit), response(response), data(data)
  {
  }

  Fit at(const Eigen::VectorXd &position) const;

  /// Predicted change from the base model, with its share of noise taken off.
  Eigen::VectorXd change(const Eigen::VectorXd &position, double &leverage) const;

private:
  const Misfit &misfit;
  const Response &response;
  const Eigen::VectorXd &data;
};

/// Range of each effect's position: what physics and the runs so far allow.
struct Bounds
{
  Eigen::VectorXd lower, upper;
};
Bounds bounds(const Workbench &bench, const EffectSet &set, const Response &response);

/// Best amplitudes within bounds, by descent along one effect after the other.
Fit minimise(const Objective &objective, const Bounds &bounds);

/// The data in coordinates of the misfit.
Eigen::VectorXd data_coordinates(const Workbench &bench);

/// Best fit of a set of effects to the data; of the base model if the set is empty.
Fit fit_model(const Workbench &bench, const EffectSet &set);

/// Amplitudes of one effect of a fitted set whose deviance, with the others at their best, stays
/// within `allowed` of the best.
struct Interval
{
  double lower, upper;       ///< in scales from the null value
  bool open_below, open_above; ///< whether it ends where the search does
};
Interval profile_interval(const Workbench &bench, const Fit &fit, std::size_t member,
                          double allowed);

} // namespace eunoe::discovery

#endif
