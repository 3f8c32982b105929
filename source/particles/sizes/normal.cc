#include <eunoe/particles/size_distribution.h>

#include <algorithm>
#include <cmath>

namespace eunoe {
namespace {

/// A density given by a function between two cut-offs, integrated and inverted on a fine table.
class Tabulated : public SizeDistribution
{
public:
  template <typename Density>
  Tabulated(double from, double to, bool by_volume, const Density &density)
      : d(n_points), cumulative(n_points, 0.)
  {
    double previous = 0.;
    for (unsigned int k = 0; k < n_points; ++k) {
      d[k] = from + (to - from) * k / (n_points - 1);
      const double cubed = d[k] * d[k] * d[k];
      const double weight = density(d[k]) / (by_volume ? cubed : 1.);
      if (k > 0) {
        const double area = 0.5 * (previous + weight) * (d[k] - d[k - 1]);
        cumulative[k] = cumulative[k - 1] + area;
        cube += area * 0.5 * (cubed + d[k - 1] * d[k - 1] * d[k - 1]);
      }
      previous = weight;
    }
    cube /= cumulative.back();
    for (double &share : cumulative)
      share /= cumulative.back();
  }

  double diameter(double u) const override
  {
    const auto it = std::upper_bound(cumulative.begin() + 1, cumulative.end() - 1, u);
    const std::size_t k = it - cumulative.begin();
    const double width = cumulative[k] - cumulative[k - 1];
    const double share = width > 0. ? (u - cumulative[k - 1]) / width : 0.;
    return d[k - 1] + share * (d[k] - d[k - 1]);
  }
  double smallest() const override { return d.front(); }
  double largest() const override { return d.back(); }
  double mean_cube() const override { return cube; }

private:
  static constexpr unsigned int n_points = 4001;

  std::vector<double> d, cumulative;
  double cube = 0.;
};

/// Cut-off where the user gave none: this many standard deviations from the mean.
constexpr double default_cut = 2.5;

std::unique_ptr<SizeDistribution> normal(const SizeDistributionParameters &p)
{
  const double mean = p.average_diameter, sigma = p.standard_deviation;
  const double from = p.smallest > 0. ? p.smallest : mean - default_cut * sigma;
  const double to = p.largest > 0. ? p.largest : mean + default_cut * sigma;
  return std::make_unique<Tabulated>(from, to, p.basis == "volume", [&](double d) {
    const double s = (d - mean) / sigma;
    return p.weight(d) * std::exp(-0.5 * s * s);
  });
}

std::unique_ptr<SizeDistribution> lognormal(const SizeDistributionParameters &p)
{
  const double ratio = p.standard_deviation / p.average_diameter;
  const double sigma = std::sqrt(std::log(1. + ratio * ratio));
  const double mu = std::log(p.average_diameter) - 0.5 * sigma * sigma;
  const double from = p.smallest > 0. ? p.smallest : std::exp(mu - default_cut * sigma);
  const double to = p.largest > 0. ? p.largest : std::exp(mu + default_cut * sigma);
  return std::make_unique<Tabulated>(from, to, p.basis == "volume", [&](double d) {
    const double s = (std::log(d) - mu) / sigma;
    return p.weight(d) * std::exp(-0.5 * s * s) / d;
  });
}

const SizeDistributionRegistry::Registration register_normal(size_distributions(), "normal",
                                                             normal);
const SizeDistributionRegistry::Registration register_lognormal(size_distributions(), "lognormal",
                                                                lognormal);

} // namespace
} // namespace eunoe
