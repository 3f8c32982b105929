#include <eunoe/core/declare.h>
#include <eunoe/engine/search_criterion.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace eunoe {

void ContactDetectionParameters::declare(dealii::ParameterHandler &prm)
{
  declare::enter(prm, "model parameters");
  declare::enter(prm, "contact detection");
  declare::choice(prm, "contact detection method", method, "constant|dynamic",
                  "Search for pairs every so many steps, or when a particle has moved too far.");
  declare::count(prm, "frequency", frequency,
                 "constant: steps between searches, of which there are more where a solid has "
                 "moved too far. dynamic looks at every step.",
                 1);
  declare::at_least(prm, "dynamic contact search size coefficient", displacement_share, 1e-3,
                    "Share of the safe displacement after which the search is repeated; more than "
                    "1 is as 1.");
  declare::number_or_word(
      prm, "neighborhood threshold", "auto", format(first_threshold), 1.,
      std::numeric_limits<double>::max(),
      "The search lists pairs with separations up to the skin, (threshold - 1) times the largest "
      "diameter. Larger: longer lists, fewer searches. 'auto': begins with 1.3 and follows the "
      "flow, from 1.05 to 2.",
      [this](const std::optional<double> &value) { neighborhood_threshold = value; });
  declare::leave(prm);
  declare::leave(prm);
}

void ContactDetectionParameters::check(const ParameterCheck &check) const
{
  const ParameterCheck::Path path = {"model parameters", "contact detection"};
  const double threshold = neighborhood_threshold.value_or(first_threshold);
  check.require(threshold > 1., path, "neighborhood threshold", "is " + format(threshold) + ".",
                "Give a value above 1, for example 1.1.");
  check.require(neighborhood_threshold || method == "dynamic", path, "neighborhood threshold",
                "is 'auto', which goes by how often particles need a search, and with 'contact "
                "detection method = constant' there is one every so many steps.",
                "Give a number, or 'contact detection method = dynamic'.");
}

void SearchCriterion::ask(const unsigned long long step, const Travel &travel,
                          const double near_share)
{
  largest = {Travel::unknown, Travel::unknown, Travel::unknown, near_share};
  const bool is_constant = parameters.method == "constant";
  if (is_constant && step % parameters.frequency != 0)
    return;
  // Whether MPI_MAX keeps a NaN depends on the MPI library.
  if (!is_constant && !std::isnan(travel.moved2))
    largest = {std::sqrt(travel.moved2), std::sqrt(travel.paces2), std::sqrt(travel.mean_step2),
               near_share};
  MPI_Iallreduce(MPI_IN_PLACE, largest.data(), static_cast<int>(largest.size()), MPI_DOUBLE,
                 MPI_MAX, comm, &answer);
}

bool SearchCriterion::is_due(const MovingSolids &solids)
{
  // Between the searches of "constant" particles are watched by the guard; solids are here, as
  // powder at rest would not see them come.
  if (answer == MPI_REQUEST_NULL)
    return solids.moved_since_search() > 0.5 * allowed;
  MPI_Wait(&answer, MPI_STATUS_IGNORE);
  return !(largest[0] + std::max(largest[0], solids.moved_since_search()) <= allowed);
}

} // namespace eunoe
