// The mesh that distributes the particles: its cells are as wide as asked and fill the domain;
// every place, also on faces and outside, is owned by the rank that has its cell; and the
// ranks near a place, across periodic ends and levels, are those that an all-to-all comparison of
// boxes finds.

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

/// Distance of a place from a box, also over the periods in x and z.
double distance(const Vec3 &place, const Forest::ForeignCell &cell, const double depth)
{
  const double period[3] = {length, 0., depth};
  double sum = 0.;
  for (unsigned int d = 0; d < 3; ++d) {
    double least = std::numeric_limits<double>::max();
    for (const int image : {-1, 0, 1})
      least = std::min(least, std::max(0., std::abs(place[d] - cell.centre[d] + image * period[d]) -
                                               cell.half[d]));
    sum += least * least;
  }
  return std::sqrt(sum);
}

std::set<int> ranks_near(const Vec3 &place, const std::vector<Forest::ForeignCell> &cells,
                         const double reach, const double depth)
{
  std::set<int> ranks;
  for (const Forest::ForeignCell &cell : cells)
    if (distance(place, cell, depth) <= reach)
      ranks.insert(cell.rank);
  return ranks;
}

/// The cells of all other ranks.
std::vector<Forest::ForeignCell> cells_of_others(const Forest &forest, MPI_Comm comm)
{
  std::vector<std::array<double, 6>> own;
  for (const auto &cell : forest.mesh().active_cell_iterators())
    if (cell->is_locally_owned()) {
      const Vec3 first = to_vec3(cell->vertex(0)), last = to_vec3(cell->vertex(7));
      own.push_back({{first.x, first.y, first.z, last.x, last.y, last.z}});
    }
  const auto all = dealii::Utilities::MPI::all_gather(comm, own);
  const auto rank = static_cast<std::size_t>(dealii::Utilities::MPI::this_mpi_process(comm));
  std::vector<Forest::ForeignCell> others;
  for (std::size_t r = 0; r < all.size(); ++r)
    for (const auto &[x0, y0, z0, x1, y1, z1] : all[r])
      if (r != rank)
        others.push_back({static_cast<int>(r),
                          {0.5 * (x0 + x1), 0.5 * (y0 + y1), 0.5 * (z0 + z1)},
                          {0.5 * (x1 - x0), 0.5 * (y1 - y0), 0.5 * (z1 - z0)}});
  return others;
}

/// Ranks that own something near the corners and the centre of each cell, beside the definition.
void check_neighbours(const Forest &forest, const double reach, const double depth, MPI_Comm comm)
{
  std::size_t wrong = 0, n = 0;
  const auto neighbours = forest.foreign_neighbours(reach);
  const std::vector<Forest::ForeignCell> others = cells_of_others(forest, comm);
  for (const auto &cell : forest.mesh().active_cell_iterators()) {
    if (!cell->is_locally_owned())
      continue;
    std::vector<Vec3> places = {to_vec3(cell->center())};
    for (const unsigned int v : cell->vertex_indices())
      places.push_back(to_vec3(cell->vertex(v)));
    for (const Vec3 &place : places) {
      const std::set<int> expected = ranks_near(place, others, reach, depth);
      wrong += ranks_near(place, neighbours[cell->active_cell_index()], reach, depth) != expected;
      n += expected.size();
    }
  }
  const bool is_alone = dealii::Utilities::MPI::n_mpi_processes(comm) == 1;
  check("ranks near", dealii::Utilities::MPI::sum(wrong, comm) == 0 &&
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
    for (const double reach : {0.9 * least_width, 2.3 * least_width})
      check_neighbours(forest, reach, depth, comm);
  }
}
