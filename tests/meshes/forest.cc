// The mesh that distributes the particles: its cells are as wide as asked and fill the domain;
// every place, also on faces and outside, is owned by the rank that has its cell; and the
// neighbours of other ranks, across periodic ends and levels, are those that an all-to-all
// comparison of boxes finds.

#include <eunoe/domain/mesh.h>
#include <eunoe/engine/forest.h>

#include <deal.II/base/mpi.h>

#include "meshes.h"

using namespace test;

namespace {

constexpr double length = 3., height = 1.25;

/// A box of 3 m x 1.25 m x @p depth, periodic in x and z.
std::string box(const double depth)
{
  return control(1e-5, 1e-5) +
         generated_mesh("hyper_rectangle",
                        "-1, 0, 0.2 : 2, 1.25, " + std::to_string(0.2 + depth) + " : true", 0) +
         powder(0.1, 0.5, 0.4, "0, -9.81, 0", "  set number of particles = 0\n") +
         periodic_in({0, 2});
}

/// Refines the cells around some places as far as it goes, and gives the ranks equal shares.
void refine(Forest &forest)
{
  bool goes_on = true;
  while (goes_on) {
    goes_on = false;
    for (int k = 0; k < 12; ++k) {
      const Vec3 x = {-1. + 0.27 * k, 0.1 * k, 0.2 + 0.08 * k};
      const Forest::ActiveCell cell = forest.find(forest.place(x));
      if (cell->is_locally_owned() && !forest.is_finest(cell)) {
        cell->set_refine_flag();
        goes_on = true;
      }
    }
    goes_on = dealii::Utilities::MPI::max(goes_on ? 1 : 0, MPI_COMM_WORLD) == 1;
    forest.mesh().execute_coarsening_and_refinement();
  }
  forest.mesh().repartition();
}

void check_cells(const Forest &forest, double least_width, double depth, MPI_Comm comm)
{
  double narrowest = 1., volume = 0.;
  for (const auto &cell : forest.mesh().active_cell_iterators())
    if (cell->is_locally_owned()) {
      volume += cell->measure();
      for (unsigned int d = 0; d < 3; ++d)
        narrowest = std::min(narrowest, cell->extent_in_direction(d));
    }
  narrowest = dealii::Utilities::MPI::min(narrowest, comm);
  volume = dealii::Utilities::MPI::sum(volume, comm);
  check("cells are as wide as asked, and not much wider",
        narrowest > (1. - 1e-9) * least_width && narrowest < 1.4 * least_width,
        std::to_string(narrowest));
  check("they fill the domain", std::abs(volume - length * height * depth) < 1e-12);
}

/// Places in and around the box, many of them on faces of cells.
std::vector<Vec3> places(const Forest &forest)
{
  std::vector<Vec3> list;
  for (int i = 0; i < 40; ++i)
    for (int j = 0; j < 20; ++j)
      for (int k = 0; k < 5; ++k)
        list.push_back({-1.3 + 0.0917 * i, -0.1 + 0.0713 * j, 0.15 + 0.0831 * k});
  for (const auto &cell : forest.mesh().cell_iterators_on_level(0))
    for (const unsigned int v : cell->vertex_indices())
      list.push_back(to_vec3(cell->vertex(v)));
  return list;
}

void check_owners(const Forest &forest, MPI_Comm comm)
{
  const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(comm);
  std::size_t owned = 0, wrong = 0, outside = 0;
  const std::vector<Vec3> all = places(forest);
  for (const Vec3 &x : all) {
    const Forest::Place place = forest.place(x);
    const Forest::ActiveCell cell = forest.find(place);
    owned += cell->is_locally_owned();
    wrong += cell->is_locally_owned() != (forest.owner(place) == rank);
    const auto centre = forest.centre(place);
    const auto corners = cell->bounding_box().get_boundary_points();
    for (unsigned int d = 0; d < 3; ++d)
      outside += centre[d] <= corners.first[d] || centre[d] >= corners.second[d];
  }
  check("every place has one owner", dealii::Utilities::MPI::sum(owned, comm) == all.size());
  check("who is known to all", dealii::Utilities::MPI::sum(wrong, comm) == 0);
  check("centres of places lie inside cells", dealii::Utilities::MPI::sum(outside, comm) == 0);
}

/// Whether two boxes touch, also over the periods in x and z.
bool touch(const Forest::ActiveCell &one, const Forest::ActiveCell &other, const double depth)
{
  const double period[3] = {length, 0., depth};
  bool touches = true;
  for (unsigned int d = 0; d < 3; ++d) {
    bool here = false;
    for (const int image : {-1, 0, 1})
      here = here || std::abs(one->center()[d] - other->center()[d] + image * period[d]) <=
                         0.5 * (one->extent_in_direction(d) + other->extent_in_direction(d)) + 1e-9;
    touches = touches && here;
  }
  return touches;
}

void check_neighbours(const Forest &forest, double depth, MPI_Comm comm)
{
  using Known = std::set<std::array<double, 4>>;
  std::size_t wrong = 0, n = 0;
  const auto neighbours = forest.foreign_neighbours();
  for (const auto &cell : forest.mesh().active_cell_iterators()) {
    if (!cell->is_locally_owned())
      continue;
    Known found, expected;
    for (const Forest::ForeignCell &near : neighbours[cell->active_cell_index()])
      found.insert({{static_cast<double>(near.rank), near.centre.x, near.centre.y, near.centre.z}});
    for (const auto &other : forest.mesh().active_cell_iterators())
      if (other->is_ghost() && touch(cell, other, depth)) {
        const Vec3 centre = 0.5 * (to_vec3(other->vertex(0)) + to_vec3(other->vertex(7)));
        expected.insert(
            {{static_cast<double>(other->subdomain_id()), centre.x, centre.y, centre.z}});
      }
    wrong += found != expected;
    n += expected.size();
  }
  const bool is_alone = dealii::Utilities::MPI::n_mpi_processes(comm) == 1;
  check("neighbours of other ranks", dealii::Utilities::MPI::sum(wrong, comm) == 0 &&
                                         (dealii::Utilities::MPI::sum(n, comm) > 0) == !is_alone);
}

} // namespace

EUNOE_MPI_TEST()
{
  MPI_Comm comm = MPI_COMM_WORLD;
  struct Shape
  {
    double depth, least_width;
    int n_levels;
  };
  for (const auto &[depth, least_width, n_levels_wanted] :
       {Shape{1., 0.06, 5}, Shape{1., 0.03, 4}, Shape{0.3, 0.11, 2}})
  {
    Case test_case(box(depth), comm);
    Forest forest(test_case->get_domain(), least_width);
    refine(forest);
    const int n_levels = dealii::Utilities::MPI::max(forest.mesh().n_global_levels(), comm);
    check("levels", n_levels == n_levels_wanted, std::to_string(n_levels));
    check_cells(forest, least_width, depth, comm);
    check_owners(forest, comm);
    check_neighbours(forest, depth, comm);
  }
}
