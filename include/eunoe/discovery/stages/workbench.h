#ifndef eunoe_discovery_stages_workbench_h
#define eunoe_discovery_stages_workbench_h

#include <eunoe/discovery/stages/archive.h>
#include <eunoe/discovery/statistics/covariance.h>
#include <eunoe/discovery/statistics/data_noise.h>
#include <eunoe/discovery/statistics/misfit.h>
#include <eunoe/discovery/statistics/modes.h>
#include <eunoe/discovery/statistics/response.h>
#include <eunoe/discovery/study.h>

#include <Eigen/Dense>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace eunoe::discovery {

/// One run of each of several experiments with one seed.
struct RunSet
{
  std::uint32_t seed = 0;
  Eigen::VectorXd values; ///< of all cells of the experiments, one experiment after the other
  Eigen::VectorXd modes;  ///< of the measured cells, once the stage null has settled them
};

/// Effects by their places in Workbench::effects.
using EffectSet = std::vector<std::size_t>;

/// What all stages of a study share: the question, the runs so far, and the statistics that the
/// stage null has settled.
struct Workbench
{
  Workbench(const StudyOptions &options, const MeasuredData &data,
            const std::vector<Factor> &factors, Laboratory &laboratory, Log &log);

  const StudyOptions &options;
  const MeasuredData &data;
  std::vector<Factor> effects, nuisances;
  Archive archive;
  Log &log;
  std::vector<std::string> notes; ///< what people should know of: cells left out, failed runs

  /// Experiments that are measured (fit), and all their cells in the order of RunSet::values.
  std::vector<std::string> experiments;
  std::vector<Cell> columns;

  /// Measured cells that are used, where they stand among the columns, and the data.
  std::vector<Cell> cells;
  std::vector<Eigen::Index> column_of_cell;
  Eigen::VectorXd value, deviation, repeats;

  // What the stage null settles.
  Modes modes;
  Covariance chaos; ///< of one run's modes
  double chaos_degrees_of_freedom = 0.;
  Eigen::VectorXd cell_chaos; ///< variance of each cell, in squared units of modes.deviations()
  DataNoise noise;
  Eigen::MatrixXd nuisance_cells; ///< change by one prior deviation, cells x nuisances, scaled
  double nuisance_noise = 0.; ///< variance of all nuisances' changes together, in units of chaos
  Misfit misfit;

  /// Runs by amplitudes.
  std::map<Amplitudes, std::vector<RunSet>> runs;

  struct Order
  {
    Amplitudes amplitudes;
    unsigned int count; ///< sets of runs that there shall be in all
  };
  /// Makes sets of runs, all orders at once. A run that failed is tried with further seeds, as
  /// often again as was ordered; the budget may leave fewer too.
  void ask(const std::vector<Order> &orders);

  const std::vector<RunSet> &base() const { return runs.at({}); }

  /// Takes the modes of all runs so far, and of those that will come.
  void settle_modes(const Modes &modes);

  /// Values of the cells that are measured and used.
  Eigen::VectorXd measured(const Eigen::VectorXd &all) const;

  /// Covariance of the data's modes and of the nuisances together, E in Misfit: what is known of
  /// the nuisances' changes, and what is not as it comes from few runs.
  Eigen::MatrixXd other_covariance(const DataNoise &data_noise,
                                   const Eigen::MatrixXd &run_chaos) const;
  /// What each cell is forgiven, in units of its chaos.
  Eigen::VectorXd tolerance() const;

  /// Amplitudes at a position, in scales from the null value.
  Amplitudes amplitudes(const EffectSet &set, const Eigen::VectorXd &position) const;

  /// Emulator of a set of effects, in modes and in coordinates of the misfit.
  Response response_of_modes(const EffectSet &set) const;
  Response response(const EffectSet &set) const
  {
    return response_of_modes(set).transformed(misfit.matrix());
  }
  /// The same for all cells of the experiments, measured or not, in their own units.
  Response response_of_columns(const EffectSet &set) const;

  /// Correlation of runs with the base run of the same seed, by the names of the effects that are
  /// not at their null value; 0 where it is too weak to pay.
  double seed_correlation(const EffectSet &active) const;

private:
  /// Mean square over modes of an effect's change at one scale, in units of chaos, without noise.
  Slopes slopes(const EffectSet &set) const;
  double estimate_correlation(const EffectSet &active) const;
  std::vector<Response::Run> runs_of(const EffectSet &set,
                                     const std::function<Eigen::VectorXd(const RunSet &)> &) const;
  std::vector<RunRequest> requests(const Amplitudes &amplitudes, std::uint32_t seed) const;
  std::uint32_t first_seed(const Amplitudes &amplitudes);

  std::map<Amplitudes, std::uint32_t> seed_offsets;
  std::map<Amplitudes, std::uint32_t> tried;        ///< seeds that were used so far
  mutable std::map<EffectSet, double> correlations; ///< that are known; renewed after each run
};

/// Names as they are written in tables: "a", "a + b".
std::string name_of(const Workbench &bench, const EffectSet &set);

} // namespace eunoe::discovery

#endif
