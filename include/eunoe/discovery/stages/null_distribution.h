#ifndef eunoe_discovery_stages_null_distribution_h
#define eunoe_discovery_stages_null_distribution_h

#include <eunoe/discovery/stages/study_state.h>

namespace eunoe::discovery {

/// The statistics that test whether something is missing from the base model.
struct TestStatistics
{
  double distance = 0.;          ///< squared Mahalanobis distance of all modes
  double largest_deviation = 0.; ///< largest deviation of a data point, in standard errors
  double gain = 0.; ///< largest fall of deviance that one effect brings, once they are known
};

/// Null distribution of the test statistics, when nothing is missing, by a nested bootstrap. Each
/// draw has replicates of the base model and repeats of the measurement of its own, and covariance,
/// noise and statistics are estimated from them as from the real ones. So thresholds account for
/// covariances that are estimated from few replicates.
struct NullDistribution
{
  std::vector<TestStatistics> draws;
  Misfit::Tail tail; ///< of distance
  double direction_limit =
      4.; ///< fall of deviance along one direction that `level` of draws exceed

  double p_distance(double distance, double share_of_modes = 1.) const;
  double p_largest_deviation(double deviation) const;
  double p_gain(double gain) const;
  /// p-value of the smallest of the three p-values (of the first two without effects).
  double p_joint(const TestStatistics &statistics, bool with_gain) const;
  /// The smallest p that so many draws can show. The true p of a value that no draw reaches may be
  /// far smaller.
  double least_p() const { return chi_square ? 0. : 1. / (1. + static_cast<double>(draws.size())); }
  /// The value that the draws exceed with this probability.
  double gain_limit(double probability) const;

  // Without a bootstrap, for comparison: chi-square and Bonferroni.
  bool chi_square = false;
  double n_modes = 0., n_points = 0., n_effects = 0.;
};

/// Standard error of the deviation between data and base model at each data point, in units of the
/// deviation between replicates.
Eigen::VectorXd standard_errors(const StudyState &study);

/// Statistics of the real data against the base model; the gain only if `emulators` are given.
TestStatistics test_statistics(const StudyState &study, const std::vector<Emulator> &emulators);

/// @param emulators of single effects in modes (not in coordinates of the misfit); none before the
///   stage screen
NullDistribution make_null_distribution(const StudyState &study,
                                        const std::vector<Emulator> &emulators);

} // namespace eunoe::discovery

#endif
