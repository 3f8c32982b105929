#include <eunoe/domain/mesh.h>
#include <eunoe/engine/forest.h>

#include <deal.II/distributed/p4est_wrappers.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>

#include <algorithm>
#include <cmath>

namespace eunoe {

namespace {

/// Most cells of the lattice along an axis; p4est can cut a cell into halves 18 times.
constexpr double most_along_axis = 1 << 24;
constexpr unsigned int most_levels = 16;
/// Every rank holds all coarse cells, and deal.II takes long to bring many of them into an order.
constexpr double most_coarse_cells = 4000.;

/// Share of the lattice cells that may be lost when their numbers are rounded to whole coarse
/// cells: parts of few large coarse cells are more compact than those of many small ones.
constexpr double lost_to_rounding = 0.25;

/// Numbers of coarse cells along the axes, and how often each can be cut.
struct Lattice
{
  std::array<double, 3> n_coarse;
  unsigned int n_levels = 0;

  /// @param least_width of a lattice cell (m); one is wider where that saves coarse cells
  Lattice(const Vec3 &extent, const double least_width)
  {
    for (unsigned int d = 0; d < 3; ++d)
      n_coarse[d] = std::min(std::max(1., std::floor(extent[d] / least_width)), most_along_axis);
    const std::array<double, 3> number = n_coarse;
    const double fewest = *std::min_element(number.begin(), number.end());
    for (unsigned int level = 1; level <= most_levels && std::ldexp(1., level) <= fewest; ++level) {
      const int exponent = static_cast<int>(level);
      std::array<double, 3> coarse;
      double kept = 1.;
      for (unsigned int d = 0; d < 3; ++d) {
        coarse[d] = std::floor(std::ldexp(number[d], -exponent));
        kept *= std::ldexp(coarse[d], exponent) / number[d];
      }
      if (kept < 1. - lost_to_rounding && product() <= most_coarse_cells)
        break;
      n_levels = level;
      n_coarse = coarse;
    }
    // A domain of few cells across cannot be cut often.
    while (product() > most_coarse_cells) {
      double &largest = *std::max_element(n_coarse.begin(), n_coarse.end());
      largest = std::ceil(0.5 * largest);
    }
  }

  double product() const { return n_coarse[0] * n_coarse[1] * n_coarse[2]; }
};

} // namespace

Forest::Forest(const Domain &domain, const double least_width)
    : box(domain.periods()), lower(domain.lower()), upper(domain.upper()),
      triangulation(domain.communicator(), dealii::Triangulation<3>::none,
                    Triangulation::no_automatic_repartitioning)
{
  const Lattice lattice(upper - lower, least_width);
  n_levels = lattice.n_levels;
  std::vector<unsigned int> counts;
  for (unsigned int d = 0; d < 3; ++d) {
    n_coarse[d] = static_cast<int>(lattice.n_coarse[d]);
    width[d] = (upper[d] - lower[d]) / (static_cast<double>(n_coarse[d]) * (1 << n_levels));
    counts.push_back(static_cast<unsigned int>(n_coarse[d]));
  }
  dealii::GridGenerator::subdivided_hyper_rectangle(triangulation, counts, to_point(lower),
                                                    to_point(upper), true);
  std::vector<dealii::GridTools::PeriodicFacePair<Cell>> pairs;
  for (unsigned int d = 0; d < 3; ++d)
    if (box.is_periodic(d))
      dealii::GridTools::collect_periodic_faces(triangulation, 2 * d, 2 * d + 1, d, pairs);
  triangulation.add_periodicity(pairs);
  const auto *const forest = triangulation.get_p4est();
  owners = std::make_unique<const CurveOwners>(
      n_coarse, n_levels,
      std::array<bool, 3>{{box.is_periodic(0), box.is_periodic(1), box.is_periodic(2)}},
      [this](const int cell) {
        return static_cast<std::int64_t>(
            triangulation.get_coarse_cell_to_p4est_tree_permutation()[cell]);
      },
      forest->mpisize, [this](const int rank) { return begin_of(rank); });
}

CurveOwners::Position Forest::begin_of(const int rank) const
{
  const auto &quadrant = triangulation.get_p4est()->global_first_position[rank];
  const auto cut = [&](const auto coordinate) {
    return static_cast<std::uint32_t>(coordinate) >> (P8EST_MAXLEVEL - n_levels);
  };
  return {static_cast<std::int64_t>(quadrant.p.which_tree),
          CurveOwners::in_turn({{cut(quadrant.x), cut(quadrant.y), cut(quadrant.z)}}, n_levels)};
}

Forest::Place Forest::place(const Vec3 &position) const
{
  const Vec3 x = box.wrap(position);
  Place found;
  for (unsigned int d = 0; d < 3; ++d) {
    const int last = (n_coarse[d] << n_levels) - 1;
    const double number = (x[d] - lower[d]) / width[d];
    found[d] = number > 0. ? static_cast<int>(std::min<double>(number, last)) : 0;
  }
  return found;
}

dealii::Point<3> Forest::centre(const Place &place) const
{
  dealii::Point<3> x;
  for (unsigned int d = 0; d < 3; ++d)
    x[d] = lower[d] + (place[d] + 0.5) * width[d];
  return x;
}

Forest::ActiveCell Forest::find(const Place &place) const
{
  Cell cell(&triangulation, 0, owners->coarse_cell(place));
  for (unsigned int level = n_levels; level-- > 0 && cell->has_children();)
    cell = cell->child((place[0] >> level & 1) | (place[1] >> level & 1) << 1 |
                       (place[2] >> level & 1) << 2);
  return cell;
}

std::vector<Forest::ForeignCell> Forest::foreign_near(const ActiveCell &cell, const double reach,
                                                      const unsigned int own_rank) const
{
  const int size = 1 << (n_levels - static_cast<unsigned int>(cell->level()));
  Place begin, end;
  for (unsigned int d = 0; d < 3; ++d) {
    const int first = static_cast<int>(std::lround((cell->vertex(0)[d] - lower[d]) / width[d]));
    const int ring = static_cast<int>(std::ceil(reach / width[d]));
    begin[d] = first - ring;
    end[d] = first + size + ring;
  }
  std::vector<ForeignCell> found;
  for (const CurveOwners::Piece &piece : owners->foreign(begin, end, static_cast<int>(own_rank))) {
    ForeignCell foreign = {piece.rank, {}, {}};
    for (unsigned int d = 0; d < 3; ++d) {
      foreign.half[d] = 0.5 * piece.size * width[d];
      foreign.centre[d] = lower[d] + piece.first[d] * width[d] + foreign.half[d];
    }
    found.push_back(foreign);
  }
  return found;
}

std::vector<std::vector<Forest::ForeignCell>> Forest::foreign_neighbours(const double reach) const
{
  std::vector<std::vector<ForeignCell>> neighbours(triangulation.n_active_cells());
  if (triangulation.ghost_owners().empty())
    return neighbours;
  const unsigned int rank =
      dealii::Utilities::MPI::this_mpi_process(triangulation.get_communicator());
  for (const auto &cell : triangulation.active_cell_iterators())
    if (cell->is_locally_owned())
      neighbours[cell->active_cell_index()] = foreign_near(cell, reach, rank);
  return neighbours;
}

Vec3 Forest::clamp(Vec3 x) const
{
  for (unsigned int d = 0; d < 3; ++d)
    if (!box.is_periodic(d))
      x[d] = std::min(std::max(x[d], lower[d]), upper[d]);
  return x;
}

} // namespace eunoe
