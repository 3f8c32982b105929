#ifndef eunoe_discovery_inference_target_h
#define eunoe_discovery_inference_target_h

#include <eunoe/core/problems.h>
#include <eunoe/discovery/inference/emulator.h>
#include <eunoe/discovery/measured_data.h>
#include <eunoe/discovery/statistics/data_noise.h>
#include <eunoe/discovery/tuned.h>

#include <algorithm>
#include <string>
#include <vector>

namespace eunoe::discovery {

/// What was measured in one experiment.
struct MeasuredExperiment
{
  std::string name;
  std::vector<DataPoint> points;
  std::vector<Eigen::Index> columns; ///< of the points in the values of a run
  Eigen::VectorXd value, deviation, repeats;
  Eigen::VectorXd least_deviation; ///< a run's scatter below this is not believed
};

/// Too few runs of the base model reached their end.
class TooFewRuns : public UserError
{
public:
  using UserError::UserError;
};

/// Sorts measured points by experiment.
std::vector<MeasuredExperiment> sort_by_experiment(const std::vector<MeasuredPoint> &points,
                                                   const Samples &samples);

/// The measurement of several experiments beside their emulators, in coordinates in which all
/// noise is independent: whitened modes, turned such that the noise of the instrument is diagonal.
class Target
{
public:
  Target(const std::vector<MeasuredExperiment> &measured, const Samples &samples,
         double model_tolerance);

  /// A prediction of all experiments.
  struct Prediction
  {
    Eigen::VectorXd mean;
    Eigen::MatrixXd gradient; ///< by nuisances
    Eigen::VectorXd leverage; ///< variance of each coordinate's mean, in runs' variances
    Eigen::VectorXd scatter;  ///< variance of each coordinate of a run
    Eigen::VectorXd common;   ///< variance of a run as a whole, for each experiment
  };
  Prediction predict(const EffectPositions &effects) const;

  /// The instrument's noise is known by its posterior: levels of equal probability stand for it.
  static constexpr std::size_t n_noise_levels = tuned::instrument::n_levels;
  /// Variance of each coordinate between data and prediction, nuisances apart, a column for each
  /// level of the instrument's noise.
  Eigen::MatrixXd variances(const Prediction &prediction) const;
  /// Its mean over the levels.
  Eigen::VectorXd variance(const Prediction &prediction) const
  {
    return variances(prediction).rowwise().mean();
  }
  /// Share of that variance which the prediction's own error makes: 0 where more runs tell nothing.
  double unknown_share(const Prediction &prediction) const
  {
    return prediction.leverage.cwiseQuotient(variance(prediction)).mean();
  }

  /// Whether there are runs of an effect in any experiment.
  bool knows(const std::size_t effect) const
  {
    return std::any_of(parts.begin(), parts.end(),
                       [&](const Part &part) { return part.emulator.knows(effect); });
  }

  const Eigen::VectorXd &data() const { return all; }
  double degrees_of_freedom() const;

  struct Part
  {
    /// @param first coordinate
    Part(const MeasuredExperiment &one, const Samples &samples, double model_tolerance,
         Eigen::Index first);

    MeasuredExperiment measured;
    ExperimentEmulator emulator;
    InstrumentNoise noise;
    Eigen::VectorXd tolerance;  ///< error of the model at each point, in base deviations
    double repeats, ratio = 1.; ///< means over the data points
    Eigen::Index first;         ///< coordinate
    /// From the scatter of one run to that of the data, in whitened modes: points that were
    /// repeated less often scatter more.
    Eigen::MatrixXd averaging;
    Eigen::MatrixXd rotation;   ///< from whitened modes to coordinates
    Eigen::VectorXd tolerated;  ///< variance of the coordinates by the model's error
    Eigen::MatrixXd instrument; ///< that of the means by the instrument: coordinates x noise levels
    Eigen::VectorXd point_ratio;  ///< variance of a repeat over that of a run, of each point
    Eigen::VectorXd mean_scatter; ///< variance of the coordinates of the data over a run's

    /// The rows of this experiment among those of all coordinates.
    template <typename Rows>
    auto of(Rows &all) const
    {
      return all.middleRows(first, emulator.size());
    }

    /// What the repeats scatter beyond the base model is the instrument's, or an effect's own.
    /// @param scatter variance of runs over that of the base model's
    double share_of_instrument(double scatter) const;
  };
  const std::vector<Part> &experiments() const { return parts; }

private:
  std::vector<Part> parts;
  Eigen::VectorXd all;
};

} // namespace eunoe::discovery

#endif
