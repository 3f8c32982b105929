#include <eunoe/core/declare.h>
#include <eunoe/state/size_distribution.h>

#include <algorithm>
#include <utility>

namespace eunoe {

SizeDistributionRegistry &size_distributions()
{
  static SizeDistributionRegistry registry("size distribution");
  return registry;
}

SizeDistributionParameters::SizeDistributionParameters()
{
  for (auto &[name, section] : size_distributions().make_all())
    kinds[name] = std::move(section);
}

std::unique_ptr<SizeDistribution> SizeDistributionParameters::make() const
{
  return kinds.at(type)->make(*this);
}

void SizeDistributionParameters::declare(dealii::ParameterHandler &prm)
{
  declare::choice(prm, "size distribution type", type, size_distributions().names(),
                  "Distribution of the diameters: 'uniform' (all alike), 'normal', 'lognormal', or "
                  "'custom' (listed classes).");
  declare::not_negative(
      prm, "average diameter", average_diameter,
      "Diameter of a uniform distribution, mean of a normal or lognormal one (m).");
  declare::alias(prm, "average diameter", "diameter");
  declare::not_negative(prm, "standard deviation", standard_deviation,
                        "Standard deviation of the diameter itself, normal and lognormal (m).");
  declare::entry(prm, "minimum diameter cutoff", smallest,
                 "Smallest diameter drawn (m); -1: 2.5 standard deviations below the mean (of the "
                 "logarithm for lognormal), none for custom.");
  declare::entry(prm, "maximum diameter cutoff", largest, "Largest diameter drawn, likewise (m).");
  declare::choice(prm, "distribution weighting basis", basis, "number|volume",
                  "Whether the distribution counts particles or volume.");
  declare::between(prm, "size weighting exponent", weighting_exponent, -50., 50.,
                   "Every share of the distribution is weighted with this power of its diameter: "
                   "below 0 for more fines, above 0 for more coarse grains, between the same "
                   "smallest and largest diameters.");
  declare::count(prm, "distribution prn seed", seed, "Seed of the random draws of the diameters.");
  for (auto &[name, section] : kinds)
    section->declare(prm);
}

void SizeDistributionParameters::read_files(const FileLoader &load)
{
  kinds.at(type)->read_files(load);
}

void SizeDistributionParameters::check(const ParameterCheck &check,
                                       const ParameterCheck::Path &path) const
{
  check_unread(check, path);
  const std::vector<std::string> unread = kinds.at(type)->unread_entries();
  const std::pair<std::string, double> cut_offs[] = {{"minimum diameter cutoff", smallest},
                                                     {"maximum diameter cutoff", largest}};
  for (const auto &[name, value] : cut_offs)
    if (std::find(unread.begin(), unread.end(), name) == unread.end())
      check.require(value > 0. || value == -1., path, name, "is " + format(value) + " m.",
                    "Give a positive diameter, or -1 for the default.");
  kinds.at(type)->check(*this, check, path);
}

void SizeDistributionParameters::check_unread(const ParameterCheck &check,
                                              const ParameterCheck::Path &path) const
{
  const std::string choice = "size distribution type";
  std::vector<std::string> unread = kinds.at(type)->unread_entries();
  for (const auto &[name, kind] : kinds)
    if (name != type)
      for (const std::string &entry : kind->own_entries())
        unread.push_back(entry);
  for (const std::string &entry : unread)
    check.advise(!check.is_changed_beside(path, entry, choice), path, entry,
                 "has no effect, as the '" + choice + "' is '" + type + "'.",
                 "Remove the entry, or choose a type that reads it.");
}

void SizeDistributionParameters::check_average(const ParameterCheck &check,
                                               const ParameterCheck::Path &path) const
{
  check.require(average_diameter > 0., path, "average diameter",
                "is " + format(average_diameter) + " m.", "Give a positive diameter.");
}

} // namespace eunoe
