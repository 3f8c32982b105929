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

SearchCriterion::SearchCriterion(const ContactDetectionParameters &parameters, const double skin,
                                 MPI_Comm comm)
    : parameters(parameters), comm(comm)
{
  set_skin(skin);
  constexpr int n_numbers = 5;
  static_assert(sizeof(Largest) == n_numbers * sizeof(double), "a Largest is numbers only");
  MPI_Type_contiguous(n_numbers, MPI_DOUBLE, &type);
  MPI_Type_commit(&type);
  constexpr int commutes = 1;
  MPI_Op_create(combine, commutes, &operation);
}

void SearchCriterion::set_skin(const double separation)
{
  skin = separation;
  allowed = std::min(1., parameters.displacement_share) * skin;
}

SearchCriterion::~SearchCriterion()
{
  MPI_Op_free(&operation);
  MPI_Type_free(&type);
}

void SearchCriterion::combine(void *one, void *both, int *n, MPI_Datatype *)
{
  const auto *const from = static_cast<const Largest *>(one);
  auto *const to = static_cast<Largest *>(both);
  for (int k = 0; k < *n; ++k) {
    to[k].displacements.note(from[k].displacements.first);
    to[k].displacements.note(from[k].displacements.second);
    to[k].paces = std::max(to[k].paces, from[k].paces);
    to[k].typical_step = std::max(to[k].typical_step, from[k].typical_step);
    to[k].near_share = std::max(to[k].near_share, from[k].near_share);
  }
}

void SearchCriterion::ask(const unsigned long long step, const Travel &travel,
                          const double near_share)
{
  constexpr double unknown = Travel::unknown;
  largest = {{unknown, unknown}, unknown, unknown, near_share};
  const bool is_constant = parameters.method == "constant";
  if (is_constant && step % parameters.frequency != 0)
    return;
  // A maximum does not keep a NaN.
  if (!is_constant && !std::isnan(travel.moved2)) {
    const TwoLargest moved2 = travel.farthest2();
    largest = {{std::sqrt(moved2.first), std::sqrt(moved2.second)},
               std::sqrt(travel.paces2),
               std::sqrt(travel.mean_step2),
               near_share};
  }
  MPI_Iallreduce(MPI_IN_PLACE, &largest, 1, type, operation, comm, &answer);
}

bool SearchCriterion::is_due(const MovingSolids &solids)
{
  // Between the searches of "constant" particles are watched by the guard; solids are here, as
  // powder at rest would not see them come.
  if (answer == MPI_REQUEST_NULL)
    return solids.moved_since_search() > 0.5 * allowed;
  MPI_Wait(&answer, MPI_STATUS_IGNORE);
  // Nobody has come closer to anybody than the two farthest particles may have to each other, or
  // the farthest and a solid.
  const auto &[farthest, second] = largest.displacements;
  return !(farthest + std::max(second, solids.moved_since_search()) <= allowed);
}

} // namespace eunoe
