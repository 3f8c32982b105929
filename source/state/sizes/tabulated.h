#ifndef eunoe_source_state_sizes_tabulated_h
#define eunoe_source_state_sizes_tabulated_h

#include <eunoe/state/size_distribution.h>

#include <algorithm>

namespace eunoe {

/// Numbers of particles between the diameters of a fine table, in each piece spread evenly.
class Tabulated : public SizeDistribution
{
public:
  /// @param diameters ascending (m)
  /// @param numbers of any scale: at the first diameter, and between each and the one before
  Tabulated(std::vector<double> diameters, const std::vector<double> &numbers)
      : d(std::move(diameters)), cumulative(numbers)
  {
    cube = numbers[0] * d[0] * d[0] * d[0];
    for (std::size_t k = 1; k < d.size(); ++k) {
      cumulative[k] += cumulative[k - 1];
      cube += numbers[k] * 0.5 * (d[k] * d[k] * d[k] + d[k - 1] * d[k - 1] * d[k - 1]);
    }
    cube /= cumulative.back();
    const double all = cumulative.back();
    for (double &share : cumulative)
      share /= all;
    std::size_t first = 0, last = d.size() - 1;
    while (first < last && !(numbers[first] > 0.))
      ++first;
    while (last > first && !(numbers[last] > 0.))
      --last;
    least = d[first > 0 ? first - 1 : 0]; // where the first piece begins
    most = d[last];
  }

  double diameter(double u) const override
  {
    if (u < cumulative.front())
      return d.front();
    const auto it = std::upper_bound(cumulative.begin() + 1, cumulative.end() - 1, u);
    const std::size_t k = it - cumulative.begin();
    const double width = cumulative[k] - cumulative[k - 1];
    const double share = width > 0. ? (u - cumulative[k - 1]) / width : 0.;
    return d[k - 1] + share * (d[k] - d[k - 1]);
  }
  double smallest() const override { return least; }
  double largest() const override { return most; }
  double mean_cube() const override { return cube; }

private:
  std::vector<double> d, cumulative;
  double cube = 0.;
  double least, most; ///< ends of the pieces that have particles (m)
};

} // namespace eunoe

#endif
