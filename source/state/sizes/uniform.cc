#include <eunoe/state/size_distribution.h>

namespace eunoe {
namespace {

class Uniform : public SizeDistribution
{
public:
  explicit Uniform(double d) : d(d) {}

  double diameter(double) const override { return d; }
  double smallest() const override { return d; }
  double largest() const override { return d; }
  double mean_cube() const override { return d * d * d; }

private:
  const double d;
};

class UniformSection : public SizeDistributionSection
{
public:
  std::vector<std::string> unread_entries() const override
  {
    return {"standard deviation", "minimum diameter cutoff", "maximum diameter cutoff",
            "distribution weighting basis"};
  }

  void check(const SizeDistributionParameters &shared, const ParameterCheck &check,
             const ParameterCheck::Path &path) const override
  {
    check.require(shared.weighting_exponent == 0., path, "size weighting exponent",
                  "is " + format(shared.weighting_exponent) + ", but all particles have one size.",
                  "Remove the entry, or choose another 'size distribution type'.");
    shared.check_average(check, path);
  }

  std::unique_ptr<SizeDistribution> make(const SizeDistributionParameters &shared) const override
  {
    return std::make_unique<Uniform>(shared.average_diameter);
  }
};

const SizeDistributionRegistry::Registration registration(size_distributions(), "uniform", [] {
  return std::make_unique<UniformSection>();
});

} // namespace
} // namespace eunoe
