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

struct SizeDistributionParameters;

/// What the input says of one kind of distribution, in entries that its own file declares in the
/// subsection of a particle type.
class SizeDistributionSection
{
public:
  virtual ~SizeDistributionSection() = default;

  virtual void declare(dealii::ParameterHandler &) {}

  /// Reads the files that the entries name; collective if @p load is. What is wrong with them is
  /// for `check` to tell.
  virtual void read_files(const FileLoader & /*load*/) {}

  /// Names of its own entries, and of the shared ones that it does not read, so that a user is told
  /// of entries without effect.
  virtual std::vector<std::string> own_entries() const { return {}; }
  virtual std::vector<std::string> unread_entries() const { return {}; }

  /// Asked of the chosen kind only.
  /// @param path of the particle type
  virtual void check(const SizeDistributionParameters &, const ParameterCheck &,
                     const ParameterCheck::Path & /*path*/) const
  {
  }

  /// @param shared entries that several kinds read
  virtual std::unique_ptr<SizeDistribution> make(
      const SizeDistributionParameters &shared) const = 0;
};

using SizeDistributionRegistry = Registry<std::unique_ptr<SizeDistributionSection>>;
SizeDistributionRegistry &size_distributions();

/// The entries of a particle type that describe its sizes. Copies share the entries of the kinds.
struct SizeDistributionParameters
{
  std::string type = "uniform";
  double average_diameter = 0.001;
  double standard_deviation = 0.;
  double smallest = -1.; ///< cut-off; -1: 2.5 standard deviations below the mean, none for custom
  double largest = -1.;
  std::string basis = "number";   ///< what the distribution counts: "number" or "volume"
  double weighting_exponent = 0.; ///< of the diameter, over all shares
  unsigned int seed = 1;

  SizeDistributionParameters();

  void declare(dealii::ParameterHandler &prm);
  /// Reads what the chosen kind has in files; collective if @p load is. Their contents belong to
  /// the parameters then: files may change before powder is filled in again.
  void read_files(const FileLoader &load);
  void check(const ParameterCheck &check, const ParameterCheck::Path &path) const;
  std::unique_ptr<SizeDistribution> make() const;
  /// For kinds that need an average diameter.
  void check_average(const ParameterCheck &check, const ParameterCheck::Path &path) const;
  /// Factor on the share of a diameter (m), of any scale.
  double weight(double diameter) const
  {
    return weighting_exponent == 0. ? 1. : std::pow(diameter / weighting_scale, weighting_exponent);
  }

private:
  /// Warns of entries that the chosen kind does not read.
  void check_unread(const ParameterCheck &check, const ParameterCheck::Path &path) const;

  static constexpr double weighting_scale = 50e-6;

  std::map<std::string, std::shared_ptr<SizeDistributionSection>> kinds;
};

} // namespace eunoe

#endif
