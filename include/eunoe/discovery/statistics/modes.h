#ifndef eunoe_discovery_statistics_modes_h
#define eunoe_discovery_statistics_modes_h

#include <eunoe/discovery/data_point.h>
#include <eunoe/discovery/tuned.h>

#include <Eigen/Dense>
#include <vector>

namespace eunoe::discovery {

/// Reduces the values at the measured data points to a few numbers, in a basis that does not depend
/// on the measured values: each value is divided by its deviation between replicates, and each
/// observable becomes its first cosine modes. Differences between replicates, along a profile or
/// from layer to layer, are nearly uncorrelated between modes, so that few replicates give a good
/// estimate of the covariance. Only the finest waves of long profiles are left out.
class Modes
{
public:
  /// Data points of one observable, in the order of their indices.
  struct Group
  {
    std::string observable;
    std::vector<Eigen::Index> points, modes;
  };

  Modes() = default;

  /// @param points of an experiment that are measured
  /// @param deviations standard deviation of each between replicates, > 0
  Modes(const std::vector<DataPoint> &points, const Eigen::VectorXd &deviations);

  /// Largest number of modes of one observable.
  static constexpr Eigen::Index most_modes = tuned::scatter::most_modes;

  Eigen::Index n_modes() const { return matrix.rows(); }
  const std::vector<Group> &groups() const { return all_groups; }

  /// Modes of values at the data points (or of differences of values).
  Eigen::VectorXd reduce(const Eigen::VectorXd &values) const;

  /// Cosines, n_modes x n_points; its rows are orthonormal.
  const Eigen::MatrixXd &basis() const { return matrix; }
  /// Standard deviation of each data point between replicates.
  const Eigen::VectorXd &deviations() const { return scale; }

private:
  Eigen::VectorXd scale;
  Eigen::MatrixXd matrix;
  std::vector<Group> all_groups;
};

} // namespace eunoe::discovery

#endif
