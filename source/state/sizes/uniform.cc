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

const SizeDistributionRegistry::Registration registration(
    size_distributions(), "uniform", [](const SizeDistributionParameters &parameters) {
      return std::make_unique<Uniform>(parameters.average_diameter);
    });

} // namespace
} // namespace eunoe
