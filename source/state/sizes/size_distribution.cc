#include <eunoe/core/declare.h>
#include <eunoe/state/size_distribution.h>

namespace eunoe {

SizeDistributionRegistry &size_distributions()
{
  static SizeDistributionRegistry registry("size distribution");
  return registry;
}

std::unique_ptr<SizeDistribution> SizeDistributionParameters::make() const
{
  return size_distributions().make(type, *this);
}

void SizeDistributionParameters::declare(dealii::ParameterHandler &prm)
{
  declare::choice(prm, "size distribution type", type, size_distributions().names(),
                  "Distribution of the diameters: 'uniform' (all alike), 'normal', 'lognormal', or "
                  "'custom' (listed classes).");
  declare::not_negative(
      prm, "average diameter", average_diameter,
      "Diameter of a uniform distribution, mean of a normal or lognormal one (m).");
  prm.declare_alias("average diameter", "diameter");
  declare::not_negative(prm, "standard deviation", standard_deviation,
                        "Standard deviation of the diameter itself, normal and lognormal (m).");
  prm.add_parameter(
      "minimum diameter cutoff", smallest,
      "Smallest diameter drawn (m); -1: 2.5 standard deviations below the mean (of the "
      "logarithm for lognormal), none for custom.");
  prm.add_parameter("maximum diameter cutoff", largest, "Largest diameter drawn, likewise (m).");
  prm.add_parameter("custom distribution diameters values", diameters,
                    "Diameters of the classes of a custom distribution (m).",
                    declare::Patterns::List(declare::Patterns::Double(0.), 1));
  prm.declare_alias("custom distribution diameters values", "custom diameters");
  prm.add_parameter("custom distribution diameters probabilities", fractions,
                    "Share of each class of a custom distribution, which sum to 1; of a CDF, the "
                    "share up to each diameter.",
                    declare::Patterns::List(declare::Patterns::Double(0.), 1));
  prm.add_parameter("custom distribution from file", from_file,
                    "Whether diameters and probabilities of a custom distribution are in a file.");
  prm.add_parameter("custom distribution filename", file,
                    "The file: a row each, diameter (m) and probability, separated by ';', ',' or "
                    "space.");
  declare::choice(prm, "custom distribution probability function type", function_type, "PDF|CDF",
                  "Whether probabilities are those of each diameter or of all up to it.");
  prm.add_parameter("custom distribution interpolation", interpolates,
                    "Whether each share is spread evenly over the diameters since the one before, "
                    "instead of having its own.");
  declare::choice(prm, "distribution weighting basis", basis, "number|volume",
                  "Whether the distribution counts particles or volume.");
  prm.add_parameter("size weighting exponent", weighting_exponent,
                    "Every share of the distribution is weighted with this power of its diameter: "
                    "below 0 for more fines, above 0 for more coarse grains, between the same "
                    "smallest and largest diameters.",
                    declare::Patterns::Double(-50., 50.));
  declare::count(prm, "distribution prn seed", seed, "Seed of the random draws of the diameters.");
}

void SizeDistributionParameters::check(const ParameterCheck &check,
                                       const ParameterCheck::Path &path) const
{
  check.require(weighting_exponent == 0. || type != "uniform", path, "size weighting exponent",
                "is " + format(weighting_exponent) + ", but all particles have one size.",
                "Remove the entry, or choose another 'size distribution type'.");
  if (type == "custom") {
    check_custom(check, path);
  } else {
    check.require(average_diameter > 0., path, "average diameter",
                  "is " + format(average_diameter) + " m.", "Give a positive diameter.");
    if (type == "normal" || type == "lognormal") {
      check.require(standard_deviation > 0., path, "standard deviation",
                    "is " + format(standard_deviation) + " m.",
                    "Give a positive deviation, or use the uniform distribution.");
      check.require(
          smallest < 0. || largest < 0. || smallest < largest, path, "minimum diameter cutoff",
          "is " + format(smallest) + " m, not below the maximum of " + format(largest) + " m.",
          "Exchange or correct the two cut-offs.");
      check.require(type != "normal" || smallest > 0. ||
                        average_diameter > 2.5 * standard_deviation,
                    path, "standard deviation",
                    "is so large that 2.5 deviations below the mean no diameter is left.",
                    "Give a positive 'minimum diameter cutoff' or a smaller deviation.");
    }
  }
}

} // namespace eunoe
