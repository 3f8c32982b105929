#include "tabulated.h"

#include <cmath>
#include <utility>

namespace eunoe {
namespace {

/// Diameters between two cut-offs (m).
struct Range
{
  double from, to;
};

/// A density given by a function between two cut-offs, integrated on a fine table.
template <typename Density>
std::unique_ptr<SizeDistribution> tabulate(const Range &range, bool by_volume,
                                           const Density &density)
{
  constexpr unsigned int n_points = 4001;
  std::vector<double> d(n_points), numbers(n_points, 0.);
  double previous = 0.;
  for (unsigned int k = 0; k < n_points; ++k) {
    d[k] = range.from + (range.to - range.from) * k / (n_points - 1);
    const double weight = density(d[k]) / (by_volume ? d[k] * d[k] * d[k] : 1.);
    if (k > 0)
      numbers[k] = 0.5 * (previous + weight) * (d[k] - d[k - 1]);
    previous = weight;
  }
  return std::make_unique<Tabulated>(std::move(d), numbers);
}

/// Cut-off where the user gave none: this many standard deviations from the mean.
constexpr double default_cut = 2.5;

Range range_of(const SizeDistributionParameters &p, const Range &where_none_is_given)
{
  return {p.smallest > 0. ? p.smallest : where_none_is_given.from,
          p.largest > 0. ? p.largest : where_none_is_given.to};
}

void check_spread(const SizeDistributionSection &section, const SizeDistributionParameters &p,
                  const Range &range, const ParameterCheck &check, const ParameterCheck::Path &path)
{
  p.check_average(check, path);
  check.require(p.standard_deviation > 0., path, "standard deviation",
                "is " + format(p.standard_deviation) + " m.",
                "Give a positive deviation, or use the uniform distribution.");
  // Other mistakes make a range that says nothing.
  const bool has_range = p.average_diameter > 0. && p.standard_deviation > 0.;
  const bool by_maximum = p.smallest <= 0.;
  check.require(!has_range || range.from < range.to, path,
                by_maximum ? "maximum diameter cutoff" : "minimum diameter cutoff",
                "leaves no diameter: from " + format(range.from) + " to " + format(range.to) +
                    " m.",
                "Correct the cut-offs; one that is not given lies 2.5 standard deviations from the "
                "mean.");
  if (has_range && range.from > 0. && range.from < range.to)
    check.require(std::isfinite(section.make(p)->mean_cube()), path, "average diameter",
                  "is " + format(p.average_diameter) +
                      " m, so many standard deviations from the cut-offs " + format(range.from) +
                      " and " + format(range.to) + " m that no particle is between them.",
                  "Give the mean of the sizes that are wanted, or a larger deviation.");
}

class Normal : public SizeDistributionSection
{
public:
  void check(const SizeDistributionParameters &p, const ParameterCheck &check,
             const ParameterCheck::Path &path) const override
  {
    check_spread(*this, p, range(p), check, path);
    check.require(p.smallest > 0. || p.average_diameter > default_cut * p.standard_deviation, path,
                  "standard deviation",
                  "is so large that 2.5 deviations below the mean no diameter is left.",
                  "Give a positive 'minimum diameter cutoff' or a smaller deviation.");
  }

  std::unique_ptr<SizeDistribution> make(const SizeDistributionParameters &p) const override
  {
    const double mean = p.average_diameter, sigma = p.standard_deviation;
    return tabulate(range(p), p.basis == "volume", [&](double d) {
      const double s = (d - mean) / sigma;
      return p.weight(d) * std::exp(-0.5 * s * s);
    });
  }

private:
  static Range range(const SizeDistributionParameters &p)
  {
    const double mean = p.average_diameter, sigma = p.standard_deviation;
    return range_of(p, {mean - default_cut * sigma, mean + default_cut * sigma});
  }
};

class Lognormal : public SizeDistributionSection
{
public:
  void check(const SizeDistributionParameters &p, const ParameterCheck &check,
             const ParameterCheck::Path &path) const override
  {
    check_spread(*this, p, range(p), check, path);
  }

  std::unique_ptr<SizeDistribution> make(const SizeDistributionParameters &p) const override
  {
    const auto [mu, sigma] = of_logarithms(p);
    return tabulate(range(p), p.basis == "volume", [mu = mu, sigma = sigma, &p](double d) {
      const double s = (std::log(d) - mu) / sigma;
      return p.weight(d) * std::exp(-0.5 * s * s) / d;
    });
  }

private:
  /// Mean and standard deviation of the logarithms.
  static std::pair<double, double> of_logarithms(const SizeDistributionParameters &p)
  {
    const double ratio = p.standard_deviation / p.average_diameter;
    const double sigma = std::sqrt(std::log(1. + ratio * ratio));
    return {std::log(p.average_diameter) - 0.5 * sigma * sigma, sigma};
  }

  static Range range(const SizeDistributionParameters &p)
  {
    const auto [mu, sigma] = of_logarithms(p);
    return range_of(p, {std::exp(mu - default_cut * sigma), std::exp(mu + default_cut * sigma)});
  }
};

const SizeDistributionRegistry::Registration normal(size_distributions(), "normal",
                                                    [] { return std::make_unique<Normal>(); });
const SizeDistributionRegistry::Registration lognormal(size_distributions(), "lognormal", [] {
  return std::make_unique<Lognormal>();
});

} // namespace
} // namespace eunoe
