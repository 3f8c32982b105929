#ifndef eunoe_discovery_stages_study_state_h
#define eunoe_discovery_stages_study_state_h

#include <eunoe/discovery/stages/archive.h>
#include <eunoe/discovery/statistics/covariance.h>
#include <eunoe/discovery/statistics/data_noise.h>
#include <eunoe/discovery/statistics/emulator.h>
#include <eunoe/discovery/statistics/misfit.h>
#include <eunoe/discovery/statistics/modes.h>
#include <eunoe/discovery/study.h>

#include <Eigen/Dense>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace eunoe::discovery {

/// One run of each measured experiment, all with the same amplitudes and the same seed.
struct Replicate
{
  std::uint32_t seed = 0;
  Eigen::VectorXd values; ///< at all data points of the experiments, one experiment after the other
  Eigen::VectorXd modes;  ///< of the measured data points, once the stage null has chosen them
};

/// Amplitudes at which the simulator runs, and how many replicates there shall be in all.
struct DesignPoint
{
  Amplitudes amplitudes;
  unsigned int n_replicates;
};

/// Effects by their indices in StudyState::effects.
using EffectSet = std::vector<std::size_t>;

/// What all stages of a study share. The first group is the question and stays as it is; the stage
/// null chooses the second and estimates the third, which later stages estimate anew from more
/// replicates.
struct StudyState
{
  StudyState(const StudyOptions &options, const MeasuredData &data,
             const std::vector<Factor> &factors, Simulator &simulator, Log &log);

  // The question.
  const StudyOptions &options;
  const MeasuredData &data;
  std::vector<Factor> effects, nuisances;
  /// Experiments that are measured (fit), and all their data points in the order of
  /// Replicate::values.
  std::vector<std::string> experiments;
  std::vector<DataPoint> columns;

  // The runs, and notes on them.
  Archive archive;
  Log &log;
  std::vector<std::string> notes; ///< for the reader: data points left out, failed runs
  std::map<Amplitudes, std::vector<Replicate>> replicates;

  // Measured data points that are compared, their columns, and what was measured there.
  std::vector<DataPoint> data_points;
  std::vector<Eigen::Index> column_of_point;
  Eigen::VectorXd value, deviation, repeats;

  // Estimates. Values are in units of modes.deviations(), the deviations between replicates.
  Modes modes;
  Covariance replicate_covariance; ///< of the modes of one replicate
  double replicate_degrees_of_freedom = 0.;
  Eigen::VectorXd replicate_variance; ///< of each data point
  DataNoise noise;
  Eigen::MatrixXd nuisance_changes; ///< by one prior deviation, data points x nuisances
  double nuisance_noise = 0.; ///< variance of all these changes together, in units of a replicate's
  Misfit misfit;

  /// Runs the simulator at all design points at once until each has its replicates. A run that
  /// fails is tried again with further seeds, as many as were asked for; the budget may leave
  /// fewer replicates too.
  void run_design(const std::vector<DesignPoint> &design);

  const std::vector<Replicate> &base() const { return replicates.at({}); }

  /// Fixes the modes, and computes those of all replicates so far.
  void set_modes(const Modes &modes);

  /// Of all values of a replicate, those at the measured data points.
  Eigen::VectorXd measured(const Eigen::VectorXd &all) const;

  /// Covariance E in Misfit: noise of the data, the nuisances' changes, and the noise of these
  /// changes, as they come from few replicates.
  Eigen::MatrixXd other_covariance(const DataNoise &data_noise,
                                   const Eigen::MatrixXd &run_covariance) const;
  /// Deviation that StudyOptions::model_tolerance forgives each data point.
  Eigen::VectorXd tolerance() const;

  /// Amplitudes at a position, in scales from the null value.
  Amplitudes amplitudes(const EffectSet &set, const Eigen::VectorXd &position) const;

  /// Emulator of a set of effects, in modes and in coordinates of the misfit.
  Emulator emulator_of_modes(const EffectSet &set) const;
  Emulator emulator(const EffectSet &set) const
  {
    return emulator_of_modes(set).transformed(misfit.matrix());
  }
  /// The same for all data points of the experiments, measured or not, in their own units.
  Emulator emulator_of_columns(const EffectSet &set) const;

  /// Correlation between replicates with these effects and replicates of the base model that have
  /// the same seed; 0 where it is too weak to use.
  double seed_correlation(const EffectSet &active) const;

private:
  /// Mean square over modes of an effect's change at one scale, in units of a replicate's variance,
  /// with the noise taken off.
  Slopes slopes(const EffectSet &set) const;
  double estimate_correlation(const EffectSet &active) const;
  std::vector<Emulator::Run> runs_of(
      const EffectSet &set, const std::function<Eigen::VectorXd(const Replicate &)> &) const;
  std::vector<RunRequest> requests(const Amplitudes &amplitudes, std::uint32_t seed) const;
  std::uint32_t first_seed(const Amplitudes &amplitudes);

  std::map<Amplitudes, std::uint32_t> seed_offsets;
  std::map<Amplitudes, std::uint32_t> tried;        ///< number of seeds that were used so far
  mutable std::map<EffectSet, double> correlations; ///< cache, emptied by run_design
};

/// Names as they are written in tables: "a", "a + b".
std::string name_of(const StudyState &study, const EffectSet &set);

} // namespace eunoe::discovery

#endif
