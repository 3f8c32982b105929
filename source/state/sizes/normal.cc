#include "tabulated.h"

#include <cmath>

namespace eunoe {
namespace {

/// A density given by a function between two cut-offs, integrated on a fine table.
template <typename Density>
std::unique_ptr<SizeDistribution> tabulate(double from, double to, bool by_volume,
                                           const Density &density)
{
  constexpr unsigned int n_points = 4001;
  std::vector<double> d(n_points), numbers(n_points, 0.);
  double previous = 0.;
  for (unsigned int k = 0; k < n_points; ++k) {
    d[k] = from + (to - from) * k / (n_points - 1);
    const double weight = density(d[k]) / (by_volume ? d[k] * d[k] * d[k] : 1.);
    if (k > 0)
      numbers[k] = 0.5 * (previous + weight) * (d[k] - d[k - 1]);
    previous = weight;
  }
  return std::make_unique<Tabulated>(std::move(d), numbers);
}

/// Cut-off where the user gave none: this many standard deviations from the mean.
constexpr double default_cut = 2.5;

void check_spread(const SizeDistributionParameters &p, const ParameterCheck &check,
                  const ParameterCheck::Path &path)
{
  p.check_average(check, path);
  check.require(p.standard_deviation > 0., path, "standard deviation",
                "is " + format(p.standard_deviation) + " m.",
                "Give a positive deviation, or use the uniform distribution.");
  check.require(
      p.smallest < 0. || p.largest < 0. || p.smallest < p.largest, path, "minimum diameter cutoff",
      "is " + format(p.smallest) + " m, not below the maximum of " + format(p.largest) + " m.",
      "Exchange or correct the two cut-offs.");
}

class Normal : public SizeDistributionSection
{
public:
  void check(const SizeDistributionParameters &p, const ParameterCheck &check,
             const ParameterCheck::Path &path) const override
  {
    check_spread(p, check, path);
    check.require(p.smallest > 0. || p.average_diameter > default_cut * p.standard_deviation, path,
                  "standard deviation",
                  "is so large that 2.5 deviations below the mean no diameter is left.",
                  "Give a positive 'minimum diameter cutoff' or a smaller deviation.");
  }

  std::unique_ptr<SizeDistribution> make(const SizeDistributionParameters &p) const override
  {
    const double mean = p.average_diameter, sigma = p.standard_deviation;
    const double from = p.smallest > 0. ? p.smallest : mean - default_cut * sigma;
    const double to = p.largest > 0. ? p.largest : mean + default_cut * sigma;
    return tabulate(from, to, p.basis == "volume", [&](double d) {
      const double s = (d - mean) / sigma;
      return p.weight(d) * std::exp(-0.5 * s * s);
    });
  }
};

class Lognormal : public SizeDistributionSection
{
public:
  void check(const SizeDistributionParameters &p, const ParameterCheck &check,
             const ParameterCheck::Path &path) const override
  {
    check_spread(p, check, path);
  }

  std::unique_ptr<SizeDistribution> make(const SizeDistributionParameters &p) const override
  {
    const double ratio = p.standard_deviation / p.average_diameter;
    const double sigma = std::sqrt(std::log(1. + ratio * ratio));
    const double mu = std::log(p.average_diameter) - 0.5 * sigma * sigma;
    const double from = p.smallest > 0. ? p.smallest : std::exp(mu - default_cut * sigma);
    const double to = p.largest > 0. ? p.largest : std::exp(mu + default_cut * sigma);
    return tabulate(from, to, p.basis == "volume", [&](double d) {
      const double s = (std::log(d) - mu) / sigma;
      return p.weight(d) * std::exp(-0.5 * s * s) / d;
    });
  }
};

const SizeDistributionRegistry::Registration normal(size_distributions(), "normal",
                                                    [] { return std::make_unique<Normal>(); });
const SizeDistributionRegistry::Registration lognormal(size_distributions(), "lognormal", [] {
  return std::make_unique<Lognormal>();
});

} // namespace
} // namespace eunoe
