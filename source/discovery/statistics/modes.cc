#include <eunoe/discovery/statistics/modes.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace eunoe::discovery {

Modes::Modes(const std::vector<DataPoint> &points, const Eigen::VectorXd &deviations)
    : scale(deviations), matrix(0, deviations.size())
{
  std::multimap<DataPoint, Eigen::Index> sorted;
  for (std::size_t c = 0; c < points.size(); ++c)
    sorted.emplace(points[c], static_cast<Eigen::Index>(c));
  for (const auto &[point, column] : sorted) {
    if (all_groups.empty() || all_groups.back().observable != point.observable)
      all_groups.push_back({point.observable, {}, {}});
    all_groups.back().points.push_back(column);
  }
  for (Group &group : all_groups) {
    const auto n = static_cast<Eigen::Index>(group.points.size());
    for (Eigen::Index m = 0; m < std::min(n, most_modes); ++m) {
      const double norm = std::sqrt((m == 0 ? 1. : 2.) / static_cast<double>(n));
      const Eigen::Index row = matrix.rows();
      group.modes.push_back(row);
      matrix.conservativeResize(row + 1, Eigen::NoChange);
      matrix.row(row).setZero();
      for (Eigen::Index k = 0; k < n; ++k)
        matrix(row, group.points[static_cast<std::size_t>(k)]) =
            norm * std::cos(M_PI * static_cast<double>(m) * (static_cast<double>(k) + 0.5) /
                            static_cast<double>(n));
    }
  }
}

Eigen::VectorXd Modes::reduce(const Eigen::VectorXd &values) const
{
  return matrix * values.cwiseQuotient(scale);
}

} // namespace eunoe::discovery
