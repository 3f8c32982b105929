#include <eunoe/discovery/statistics/modes.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace eunoe::discovery {

Modes::Modes(const std::vector<DataPoint> &points, const Eigen::VectorXd &deviations)
    : scale(deviations)
{
  std::map<std::pair<std::string, std::string>, std::vector<Eigen::Index>> sorted;
  for (std::size_t c = 0; c < points.size(); ++c)
    sorted[{points[c].experiment, points[c].observable}].push_back(static_cast<Eigen::Index>(c));

  Eigen::Index n_modes = 0;
  for (auto &[name, members] : sorted) {
    std::sort(members.begin(), members.end(), [&](Eigen::Index a, Eigen::Index b) {
      return points[static_cast<std::size_t>(a)] < points[static_cast<std::size_t>(b)];
    });
    n_modes += std::min<Eigen::Index>(static_cast<Eigen::Index>(members.size()), most_modes);
  }

  matrix = Eigen::MatrixXd::Zero(n_modes, static_cast<Eigen::Index>(points.size()));
  Eigen::Index row = 0;
  for (const auto &[name, members] : sorted) {
    Group group{name.first, name.second, members, {}};
    const auto n = static_cast<Eigen::Index>(members.size());
    for (Eigen::Index m = 0; m < std::min(n, most_modes); ++m, ++row) {
      const double norm = std::sqrt((m == 0 ? 1. : 2.) / static_cast<double>(n));
      for (Eigen::Index k = 0; k < n; ++k)
        matrix(row, members[static_cast<std::size_t>(k)]) =
            norm * std::cos(M_PI * static_cast<double>(m) * (static_cast<double>(k) + 0.5) /
                            static_cast<double>(n));
      group.modes.push_back(row);
    }
    all_groups.push_back(group);
  }
}

Eigen::VectorXd Modes::reduce(const Eigen::VectorXd &values) const
{
  return matrix * values.cwiseQuotient(scale);
}

} // namespace eunoe::discovery
