#include <eunoe/contact/contact_grid.h>
#include <eunoe/core/simd.h>

#include "cell_order.h"

#include <algorithm>

namespace eunoe {
namespace {

/// From this share of particles on that have moved (one over it), a list is made as if all had.
constexpr std::size_t most_moved = 3;

/// What decides which particles are pairs, in the order of cells, one array per component.
class Spheres
{
public:
  /// Behind the last there is room for a whole batch.
  static constexpr std::int32_t batch = 8;

  Spheres(const ParticleArrays &p, const std::vector<std::int32_t> &rows)
      : rows(rows), n_owned(static_cast<std::int32_t>(p.n_owned))
  {
    for (auto *component : {&x, &y, &z, &radius})
      component->assign(rows.size() + batch, 0.);
    id.resize(rows.size());
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const Vec3 &place = p.reference[rows[k]];
      x[k] = place.x;
      y[k] = place.y;
      z[k] = place.z;
      radius[k] = p.radius(rows[k]);
      id[k] = p.id[rows[k]];
    }
  }

  /// Writes the pairs of sphere @p a with those of a run that have a separation of less than
  /// @p reach and are not both ghosts: the rows of the lower ids to @p i, of the higher ones to
  /// @p j, which need room for as many as the run has and one more.
  /// @return number of pairs
  EUNOE_MULTIVERSION std::int32_t find_near(const std::size_t a, const CellRun &run,
                                            const double reach, const Vec3 &period,
                                            const Vec3 &half, std::int32_t *i,
                                            std::int32_t *j) const
  {
    const double ax = x[a], ay = y[a], az = z[a], radius_a = radius[a] + reach;
    std::int32_t n_near = 0;
    for (std::int32_t first = run.begin; first < run.end; first += batch) {
      alignas(64) double excess[batch];
      const double *const bx = &x[first], *const by = &y[first], *const bz = &z[first],
                          *const br = &radius[first];
#pragma omp simd
      for (std::int32_t k = 0; k < batch; ++k) {
        const double dx = shortest_image(bx[k] - ax, half.x, period.x);
        const double dy = shortest_image(by[k] - ay, half.y, period.y);
        const double dz = shortest_image(bz[k] - az, half.z, period.z);
        const double near = radius_a + br[k];
        excess[k] = dx * dx + dy * dy + dz * dz - near * near;
      }
      // Without branches, which could not be foretold; few are near, so the rest waits.
      const std::int32_t count = std::min(batch, run.end - first);
      for (std::int32_t k = 0; k < count; ++k) {
        i[n_near] = first + k;
        n_near += static_cast<std::int32_t>(excess[k] < 0.);
      }
    }
    const std::int32_t row_a = rows[a];
    const ParticleId id_a = id[a];
    const bool a_is_owned = row_a < n_owned;
    std::int32_t n = 0;
    for (std::int32_t k = 0; k < n_near; ++k) {
      const std::int32_t b = i[k], row = rows[b];
      const bool is_lower = id[b] < id_a;
      i[n] = is_lower ? row : row_a;
      j[n] = is_lower ? row_a : row;
      n += static_cast<std::int32_t>(a_is_owned) | static_cast<std::int32_t>(row < n_owned);
    }
    return n;
  }

private:
  const std::vector<std::int32_t> &rows;
  const std::int32_t n_owned;
  std::vector<double> x, y, z, radius;
  std::vector<ParticleId> id;
};

/// Finds the pairs of one particle after the other, in the order of cells.
class PairFinder
{
public:
  PairFinder(const ParticleArrays &p, const CellOrder &order,
             const std::vector<std::array<int, 3>> &cells, const PeriodicBox &box,
             const std::array<bool, 3> &periodic, const double reach)
      : order(order), cells(cells), period(box.length), half(box.half()), periodic(periodic),
        reach(reach), spheres(p, order.rows)
  {
  }

  /// Appends the pairs of which the particle at a place comes first.
  void append(const std::size_t place, PairList &pairs)
  {
    const std::array<int, 3> &own_cell = cells[order.rows[place]];
    if (run_cell == nullptr || *run_cell != own_cell) {
      n_runs = order.runs_around(own_cell, periodic, runs.data());
      run_cell = &own_cell;
      std::size_t most = 1;
      for (unsigned int r = 0; r < n_runs; ++r)
        most += runs[r].end - runs[r].begin;
      i.resize(std::max(i.size(), most));
      j.resize(std::max(j.size(), most));
    }
    std::int32_t found = 0;
    for (unsigned int r = 0; r < n_runs; ++r) {
      const CellRun rest = {std::max(runs[r].begin, static_cast<std::int32_t>(place) + 1),
                            runs[r].end};
      found += spheres.find_near(place, rest, reach, period, half, &i[found], &j[found]);
    }
    pairs.append(i.data(), j.data(), found);
  }

private:
  const CellOrder &order;
  const std::vector<std::array<int, 3>> &cells;
  const Vec3 period, half;
  const std::array<bool, 3> periodic;
  const double reach;
  const Spheres spheres;
  std::array<CellRun, 27> runs;
  unsigned int n_runs = 0;
  const std::array<int, 3> *run_cell = nullptr;
  std::vector<std::int32_t> i, j;
};

/// The pairs of the last search and their groups.
class FormerPairs
{
public:
  FormerPairs(PairList &&pairs, const ContactGrid::Found &found)
      : pairs(std::move(pairs)), groups(found.groups), partners(found.groups.size(), {-1, 0})
  {
  }

  void append_group(const std::int32_t row, PairList &to) const
  {
    to.append(pairs, groups[row].begin, groups[row].end);
  }

  /// Gives the records of contacts to the same pairs of a new list, from @p begin on.
  /// @param row that comes first in all of them
  void give_records(PairList &to, const std::size_t begin, const std::int32_t row)
  {
    for (std::uint32_t f = groups[row].begin; f < groups[row].end; ++f)
      partners[partner(pairs, f, row)] = {row, pairs.record[f]};
    for (std::size_t k = begin; k < to.size(); ++k) {
      const std::int32_t other = partner(to, k, row);
      // The other may have come first before.
      to.record[k] = partners[other].of == row ? partners[other].record : record_of(other, row);
    }
  }

private:
  /// Of a row, as marked last.
  struct Partner
  {
    std::int32_t of, record;
  };

  static std::int32_t partner(const PairList &list, const std::size_t k, const std::int32_t row)
  {
    return list.i[k] == row ? list.j[k] : list.i[k];
  }

  /// Record of the pair of two rows of which @p first came first; none if there was none.
  std::int32_t record_of(const std::int32_t first, const std::int32_t second) const
  {
    for (std::uint32_t f = groups[first].begin; f < groups[first].end; ++f)
      if (partner(pairs, f, first) == second)
        return pairs.record[f];
    return ContactMemory::none;
  }

  const PairList pairs;
  const std::vector<ContactGrid::Found::Group> groups;
  std::vector<Partner> partners; ///< by row
};

/// Lists all pairs and notes their groups.
/// @param former if not null, has the records of their contacts
void list_all(PairFinder &finder, const std::vector<std::int32_t> &rows, PairList &pairs,
              ContactGrid::Found *const found, FormerPairs *const former)
{
  if (found != nullptr)
    found->groups.resize(rows.size());
  for (std::size_t place = 0; place < rows.size(); ++place) {
    const std::size_t begin = pairs.size();
    finder.append(place, pairs);
    if (former != nullptr)
      former->give_records(pairs, begin, rows[place]);
    if (found != nullptr)
      found->groups[rows[place]] = {static_cast<std::uint32_t>(begin),
                                    static_cast<std::uint32_t>(pairs.size())};
  }
}

} // namespace

ContactGrid::ContactGrid(const Vec3 &lower, const Vec3 &upper, const PeriodicBox &box,
                         const double cell_size)
    : lower_from_centre(lower), lower(lower), box(box), axis({{0, 1, 2}})
{
  const Vec3 extent = upper - lower;
  std::sort(axis.begin(), axis.end(), [&](int a, int b) { return extent[a] > extent[b]; });
  // Wider cells find the same pairs. With so many along each axis the numbers of cells fit.
  constexpr double most = 1 << 20;
  for (unsigned int d = 0; d < 3; ++d) {
    n[d] = static_cast<int>(std::min(std::max(1., std::floor(extent[axis[d]] / cell_size)), most));
    inverse_width[d] = n[d] / extent[axis[d]];
  }
}

ContactGrid::Cell ContactGrid::cell(const Vec3 &x) const
{
  Cell c;
  for (unsigned int d = 0; d < 3; ++d) {
    const double s = (x[axis[d]] - lower[axis[d]]) * inverse_width[d];
    c[d] = s > 0. ? static_cast<int>(std::min<double>(s, n[d] - 1)) : 0;
  }
  return c;
}

std::uint64_t ContactGrid::key(const Vec3 &x) const
{
  const Cell c = cell(x);
  return (static_cast<std::uint64_t>(c[0]) * n[1] + c[1]) * n[2] + c[2];
}

std::vector<ContactGrid::Cell> ContactGrid::cells_of(const ParticleArrays &p) const
{
  std::vector<Cell> cells(p.size());
  for (std::size_t row = 0; row < p.size(); ++row)
    cells[row] = cell(p.reference[row]);
  return cells;
}

std::array<bool, 3> ContactGrid::periodic_axes() const
{
  return {{box.is_periodic(axis[0]), box.is_periodic(axis[1]), box.is_periodic(axis[2])}};
}

void ContactGrid::find_pairs(const ParticleArrays &p, const double reach, PairList &pairs,
                             Found *const found) const
{
  const std::vector<Cell> cells = cells_of(p);
  const CellOrder order(cells, p, n);
  PairFinder finder(p, order, cells, box, periodic_axes(), reach);
  list_all(finder, order.rows, pairs, found, nullptr);
  if (found != nullptr)
    found->lower = lower;
}

void ContactGrid::find_pairs_again(const ParticleArrays &p, const double reach,
                                   const std::vector<Moved> &moved, PairList &pairs,
                                   Found &found) const
{
  const std::size_t room = pairs.i.capacity();
  FormerPairs former(pairs.take_pairs(), found);
  pairs.reserve(room);
  const std::vector<Cell> cells = cells_of(p);
  CellOrder order(cells, p, n);
  const std::array<bool, 3> periodic = periodic_axes();
  PairFinder finder(p, order, cells, box, periodic, reach);
  if (norm_square(lower - found.lower) > 0. || !order.has_table() ||
      most_moved * moved.size() > p.size())
  {
    list_all(finder, order.rows, pairs, &found, &former);
    found.lower = lower;
    return;
  }
  for (const Moved &one : moved) {
    const Cell from = cell(one.from);
    order.mark_around(from, periodic);
    if (from != cells[one.row])
      order.mark_around(cells[one.row], periodic);
  }
  for (std::size_t place = 0; place < order.rows.size(); ++place) {
    const std::int32_t row = order.rows[place];
    const std::size_t begin = pairs.size();
    if (order.is_marked(cells[row])) {
      finder.append(place, pairs);
      former.give_records(pairs, begin, row);
    } else
      former.append_group(row, pairs);
    found.groups[row] = {static_cast<std::uint32_t>(begin),
                         static_cast<std::uint32_t>(pairs.size())};
  }
}

} // namespace eunoe
