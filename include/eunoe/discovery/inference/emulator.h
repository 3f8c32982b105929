#ifndef eunoe_discovery_inference_emulator_h
#define eunoe_discovery_inference_emulator_h

#include <eunoe/discovery/inference/samples.h>
#include <eunoe/discovery/inference/scatter.h>
#include <eunoe/discovery/statistics/gaussian_process.h>
#include <eunoe/discovery/statistics/modes.h>

#include <functional>
#include <vector>

namespace eunoe::discovery {

/// Emulator of one experiment: what runs give, at any amplitudes of effects and nuisances, and how
/// much they scatter. It knows a few modes of the measured data points, whitened such that the
/// scatter of one run of the base model is a unit matrix.
class ExperimentEmulator
{
public:
  /// @param samples of the experiment, at least four of the base model
  /// @param columns of the measured data points in a sample's values
  /// @param points their names
  /// @param least_deviation of each data point: a smaller scatter is not believed
  ExperimentEmulator(const FactorSpace &space, const std::vector<Sample> &samples,
                     const std::vector<Eigen::Index> &columns, const std::vector<DataPoint> &points,
                     const Eigen::VectorXd &least_deviation);

  Eigen::Index size() const { return whitening.rows(); }
  const Modes &modes() const { return reduction; }
  /// Whitened modes of values at the data points, less those of the base model's mean.
  Eigen::VectorXd whiten(const Eigen::VectorXd &values) const;
  /// whiten() of columns that are in units of the data points' deviations.
  Eigen::MatrixXd whiten_scaled(const Eigen::MatrixXd &columns) const;

  struct Prediction
  {
    GaussianProcess::Prediction outcome;
    Eigen::VectorXd scatter; ///< variance of each whitened mode of a run
    double common = 1.;      ///< variance of all modes as a whole
  };
  /// Whether there are runs of an effect.
  bool knows(std::size_t effect) const { return processes[effect].n_points() > 0; }
  /// Prediction of a set of effects at their positions.
  Prediction predict(const EffectPositions &effects) const;
  /// Variance of each data point of a run over that of the base model, for one of whitened modes.
  Eigen::VectorXd growth(const Eigen::VectorXd &scatter) const;

  /// Deviations of runs from the mean of their design point, as whitened rows that have the scatter
  /// of a new run, and the degrees of freedom of the covariance that is estimated from them.
  const Eigen::MatrixXd &deviations() const { return residuals; }
  double degrees_of_freedom() const { return dof; }
  /// Share by which a run's own part in that covariance shortens its squared distance.
  double own_share() const { return own; }
  /// Covariance of the modes of one run of the base model.
  Eigen::MatrixXd mode_covariance() const;
  Eigen::MatrixXd unwhitening() const;
  /// Mean and standard deviation of the base model's runs at each data point.
  const Eigen::VectorXd &base_mean() const { return mean; }
  const Eigen::VectorXd &base_deviation() const { return reduction.deviations(); }
  /// Mean of the values at the data points that a prediction of whitened modes stands for.
  Eigen::VectorXd values(const Eigen::VectorXd &whitened) const;

private:
  /// Runs at one position.
  struct Group
  {
    Eigen::VectorXd position, mean; ///< mean of the modes
    Eigen::MatrixXd rows;           ///< of modes
    int effect = -1;                ///< the only one that is not zero; -1: none, -2: several
    double amplitude() const;       ///< of that effect
  };
  std::vector<Group> make_groups(const std::vector<Sample> &samples,
                                 const std::vector<Eigen::Index> &columns) const;
  /// Whether runs scatter as those of the base model do: without effects, or with one that changes
  /// little. Where an effect is strong, single modes may scatter ten times as much, and deviations
  /// of all runs together have far too heavy tails for a test of whether anything is missing.
  bool is_near_base(const Group &group) const;
  Scatter::Replicates whitened(const Group &group) const;
  /// From the replicates of those groups that meet a condition.
  void estimate_covariance(const std::vector<Group> &groups,
                           const std::function<bool(const Group &)> &condition);
  void fit_scatter(const std::vector<Group> &groups);
  BaseInformation information_of_base(const std::vector<Group> &groups) const;

  std::size_t n_effects, n_nuisances;
  Modes reduction;
  Eigen::VectorXd mean;
  Eigen::MatrixXd whitening, residuals;
  double dof = 1., own = 0.;
  Scatter chaos;
  GaussianProcess::Prediction alone; ///< of the base model
  std::vector<GaussianProcess> processes;
};

} // namespace eunoe::discovery

#endif
