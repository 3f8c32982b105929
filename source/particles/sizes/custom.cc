#include <eunoe/particles/size_distribution.h>

#include <algorithm>

namespace eunoe {
namespace {

/// Classes of equal diameters. A share of the volume becomes a share of the number by dividing by
/// the cube of the diameter.
class Custom : public SizeDistribution
{
public:
  Custom(const std::vector<double> &diameters, std::vector<double> shares, bool by_volume)
      : diameters(diameters), cumulative(std::move(shares))
  {
    if (by_volume)
      for (std::size_t c = 0; c < diameters.size(); ++c)
        cumulative[c] /= diameters[c] * diameters[c] * diameters[c];
    double sum = 0.;
    for (std::size_t c = 0; c < diameters.size(); ++c) {
      cube += cumulative[c] * diameters[c] * diameters[c] * diameters[c];
      sum += cumulative[c];
      cumulative[c] = sum;
    }
    cube /= sum;
    for (double &share : cumulative)
      share /= sum;
  }

  double diameter(double u) const override
  {
    const auto it = std::upper_bound(cumulative.begin(), cumulative.end() - 1, u);
    return diameters[it - cumulative.begin()];
  }
  double smallest() const override { return *std::min_element(diameters.begin(), diameters.end()); }
  double largest() const override { return *std::max_element(diameters.begin(), diameters.end()); }
  double mean_cube() const override { return cube; }

private:
  const std::vector<double> diameters;
  std::vector<double> cumulative;
  double cube = 0.;
};

const SizeDistributionRegistry::Registration registration(
    size_distributions(), "custom", [](const SizeDistributionParameters &parameters) {
      std::vector<double> shares = parameters.fractions;
      for (std::size_t c = 0; c < shares.size(); ++c)
        shares[c] *= parameters.weight(parameters.diameters[c]);
      return std::make_unique<Custom>(parameters.diameters, std::move(shares),
                                      parameters.basis == "volume");
    });

} // namespace
} // namespace eunoe
