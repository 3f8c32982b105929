#ifndef eunoe_state_size_distribution_h
#define eunoe_state_size_distribution_h

#include <eunoe/core/parameter_section.h>
#include <eunoe/core/registry.h>

#include <cmath>
#include <memory>

namespace eunoe {

/// Diameters of a particle type, drawn by inverting the distribution: the same uniform number
/// gives the same diameter on every rank. SI units.
class SizeDistribution
{
public:
  virtual ~SizeDistribution() = default;

  /// The diameter below which lies the share @p u in [0, 1) of the **number** of particles.
  virtual double diameter(double u) const = 0;

  virtual double smallest() const = 0;
  virtual double largest() const = 0;

  /// Mean of the cube of the diameter (m3), which turns masses into numbers.
  virtual double mean_cube() const = 0;
};

/// Diameters (m) and the share of each.
struct SizeTable
{
  std::vector<double> diameters, shares;
};

/// The entries of a particle type that describe its sizes.
struct SizeDistributionParameters
{
  std::string type = "uniform";
  double average_diameter = 0.001;
  double standard_deviation = 0.;
  double smallest = -1.; ///< cut-off; -1: 2.5 standard deviations below the mean, none for custom
  double largest = -1.;
  std::vector<double> diameters = {0.001, 0.0005};
  std::vector<double> fractions = {0.6, 0.4};
  bool from_file = false; ///< the two lists are in a file
  std::string file = "custom_distribution.txt";
  std::string function_type = "PDF"; ///< of each diameter, or "CDF": up to it
  bool interpolates = false;         ///< sizes between the listed ones
  std::string basis = "number";      ///< what the distribution counts: "number" or "volume"
  double weighting_exponent = 0.;    ///< of the diameter, over all shares
  unsigned int seed = 1;

  void declare(dealii::ParameterHandler &prm);
  void check(const ParameterCheck &check, const ParameterCheck::Path &path) const;
  std::unique_ptr<SizeDistribution> make() const;
  /// Of a custom distribution. Throws std::invalid_argument if its file cannot be read.
  SizeTable table() const;
  /// Factor on the share of a diameter (m), of any scale.
  double weight(double diameter) const
  {
    return weighting_exponent == 0. ? 1. : std::pow(diameter / weighting_scale, weighting_exponent);
  }

private:
  void check_custom(const ParameterCheck &check, const ParameterCheck::Path &path) const;

  static constexpr double weighting_scale = 50e-6;
};

using SizeDistributionRegistry =
    Registry<std::unique_ptr<SizeDistribution>, const SizeDistributionParameters &>;
SizeDistributionRegistry &size_distributions();

} // namespace eunoe

#endif
