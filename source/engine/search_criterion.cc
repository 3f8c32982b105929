#include <eunoe/core/declare.h>
#include <eunoe/engine/search_criterion.h>

#include <algorithm>
#include <cmath>

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
  declare::at_least(prm, "neighborhood threshold", neighborhood_threshold, 1.,
                    "The search lists pairs with separations up to the skin, (threshold - 1) times "
                    "the largest diameter. Larger: longer lists, fewer searches.");
  declare::leave(prm);
  declare::leave(prm);
}

void ContactDetectionParameters::check(const ParameterCheck &check) const
{
  check.require(neighborhood_threshold > 1., {"model parameters", "contact detection"},
                "neighborhood threshold", "is " + format(neighborhood_threshold) + ".",
                "Give a value above 1, for example 1.1.");
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
