#ifndef eunoe_discovery_statistics_modes_h
#define eunoe_discovery_statistics_modes_h

#include <eunoe/discovery/cell.h>

#include <Eigen/Dense>

#include <vector>

namespace eunoe::discovery {

/// Measured cells as few numbers, by a basis that is chosen without a look at the data: each cell
/// is divided by its chaos, and each observable becomes its first cosine modes. Chaos along a
/// profile or from layer to layer is nearly uncorrelated between modes, so that a covariance is
/// estimated well from few runs, and what is left out is the finest waves of long profiles.
class Modes
{
public:
  /// Cells of one observable of one experiment, in the order of their indices.
  struct Group
  {
    std::string experiment, observable;
    std::vector<Eigen::Index> cells, modes;
  };

  Modes() = default;

  /// @param cells that are measured
  /// @param deviations standard deviation of each in one run, > 0
  Modes(const std::vector<Cell> &cells, const Eigen::VectorXd &deviations);

  /// Most modes of one observable.
  static constexpr Eigen::Index most_modes = 12;

  Eigen::Index n_cells() const { return scale.size(); }
  Eigen::Index n_modes() const { return matrix.rows(); }
  const std::vector<Group> &groups() const { return all_groups; }

  /// Number of the experiment to which a mode belongs.
  const std::vector<int> &experiment_of_mode() const { return experiment; }

  /// Modes of values of cells (or of differences of such).
  Eigen::VectorXd reduce(const Eigen::VectorXd &values) const
  {
    return matrix * values.cwiseQuotient(scale);
  }

  /// Cosines, n_modes x n_cells; its rows are orthonormal.
  const Eigen::MatrixXd &basis() const { return matrix; }
  /// Standard deviation of each cell in one run.
  const Eigen::VectorXd &deviations() const { return scale; }

private:
  Eigen::VectorXd scale;
  Eigen::MatrixXd matrix;
  std::vector<Group> all_groups;
  std::vector<int> experiment;
};

} // namespace eunoe::discovery

#endif
