// When contacts are searched: as soon as two bodies together may have moved by the allowed share of
// the skin, on whatever rank they are.

#include <eunoe/engine/search_criterion.h>

#include "moving_solids.h"

#include <limits>

using namespace test;

namespace {

constexpr double skin = 1.;

/// @param moved largest displacement of a particle on the last rank, none on the others
/// @param solid_moved displacement of a solid
bool is_due(const ContactDetectionParameters &parameters, double moved, double solid_moved,
            unsigned long long step = 1)
{
  MovingSolids solids;
  solids.take({rising("floor", 1.)});
  solids.note_search();
  solids.move_to(solid_moved);
  int n_ranks, rank;
  MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  SearchCriterion criterion(parameters, skin, MPI_COMM_WORLD);
  criterion.ask(step, {rank + 1 == n_ranks ? moved * moved : 0.}, 0.);
  return criterion.is_due(solids);
}

/// Whether ranks that would list near pairs at different steps are told the same.
bool is_share_common()
{
  int n_ranks, rank;
  MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  const ContactDetectionParameters parameters;
  SearchCriterion criterion(parameters, skin, MPI_COMM_WORLD);
  criterion.ask(1, {0.}, 1. / (1. + rank));
  criterion.is_due(MovingSolids());
  const bool first = criterion.largest_near_share() == 1.;
  criterion.ask(2, {0.}, 1. + rank);
  criterion.is_due(MovingSolids());
  return first && criterion.largest_near_share() == n_ranks;
}

} // namespace

EUNOE_MPI_TEST()
{
  ContactDetectionParameters parameters;
  check_close("skin of a threshold of 1.3", parameters.skin(2.), 0.6, 1e-15);
  check_close("allowed share of the skin",
              SearchCriterion(parameters, skin, MPI_COMM_WORLD).allowed_displacement(), 0.8, 1e-15);
  check("two particles towards each other",
        !is_due(parameters, 0.39, 0.) && is_due(parameters, 0.41, 0.));
  check("a particle and a faster solid",
        !is_due(parameters, 0.2, 0.59) && is_due(parameters, 0.2, 0.61));
  check("a solid alone", !is_due(parameters, 0., 0.79) && is_due(parameters, 0., 0.81));
  check("a slower solid is none of the two", !is_due(parameters, 0.39, 0.3));
  check("no number", is_due(parameters, std::numeric_limits<double>::quiet_NaN(), 0.));
  check("near pairs are listed at the same steps on all ranks", is_share_common());
  parameters.frequency = 10;
  check("dynamic looks at every step", is_due(parameters, 1., 1., 9));
  parameters.method = "constant";
  check("constant: then always", !is_due(parameters, 1., 0., 9) && is_due(parameters, 0., 0., 10));
  check("and when a solid has come near", is_due(parameters, 0., 1., 9));
}
