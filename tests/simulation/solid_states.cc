// The solids of a run: where they are, how far they have moved since the last search, the loads of
// the particles on all ranks, and their state after a restart.
// Reference: the path of a steady motion.

#include <eunoe/engine/moving_solids.h>

#include "moving_solids.h"
#include <nlohmann/json.hpp>

using namespace test;

EUNOE_MPI_TEST()
{
  MovingSolids solids;
  solids.take({rising("slow", 1.), rising("fast", 3.)});
  solids.move_to(2.);
  solids.note_search();
  check_close("nothing has moved since the search", solids.moved_since_search(), 0., 0.);
  solids.move_to(2.5);
  check_close("the fastest counts", solids.moved_since_search(), 1.5, 1e-15);

  MovingSolids continued;
  continued.take({rising("slow", 1.), rising("fast", 3.)});
  continued.load(nlohmann::ordered_json::parse(solids.save().dump()));
  check("back where they were at the search", continued.list()[1].state.centre.z == 6.);
  continued.move_to(2.5);
  check("and as far from there", continued.moved_since_search() == solids.moved_since_search());

  std::string refused;
  try {
    MovingSolids more;
    more.take({rising("a", 0.), rising("b", 0.), rising("c", 0.)});
    more.load(solids.save());
  } catch (const nlohmann::json::exception &) {
    refused = "yes";
  }
  check("too few states are refused", refused == "yes");

  int n_ranks, rank;
  MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  solids.new_loads()[1].force[2] += rank + 1.;
  check_close("loads of all ranks", solids.global_loads(MPI_COMM_WORLD)[1].force[2].value(),
              0.5 * n_ranks * (n_ranks + 1.), 0.);
  // Another number for each component of each solid.
  std::vector<SolidLoad> &loads = solids.new_loads();
  for (std::size_t s = 0; s < loads.size(); ++s) {
    const double ten = s == 0 ? 1. : 10.;
    loads[s].add(ten * Vec3{1., 2., 3.}, ten * Vec3{4., 5., 6.});
  }
  const std::vector<SolidLoad> sums = solids.global_loads(MPI_COMM_WORLD);
  bool in_place = sums.size() == 2;
  for (std::size_t s = 0; s < sums.size(); ++s)
    for (unsigned int d = 0; d < 3; ++d) {
      const double ten = s == 0 ? n_ranks : 10. * n_ranks;
      in_place = in_place && sums[s].force[d].value() == ten * (1. + d) &&
                 sums[s].torque[d].value() == ten * (4. + d);
    }
  check("each component is summed in its place", in_place);
  solids.new_loads();
  check_close("summed from zero", solids.global_loads(MPI_COMM_WORLD)[1].force[2].value(), 0., 0.);
}
