#include <eunoe/contact/contact_grid.h>
#include <eunoe/contact/living_contacts.h>
#include <eunoe/core/simd.h>

#include <algorithm>
#include <numeric>

namespace eunoe {
namespace {

/// A run of neighbouring cells, as places in the order of particles: [begin, end).
struct Run
{
  std::int32_t begin, end;
};

/// Sorts runs and unites those that overlap (a period of one or two cells meets itself).
unsigned int unite(Run *runs, unsigned int n)
{
  std::sort(runs, runs + n, [](const Run &a, const Run &b) { return a.begin < b.begin; });
  unsigned int last = 0;
  for (unsigned int r = 1; r < n; ++r)
    if (runs[r].begin < runs[last].end)
      runs[last].end = std::max(runs[last].end, runs[r].end);
    else
      runs[++last] = runs[r];
  return n == 0 ? 0 : last + 1;
}

/// The particles of a rank in the order of (cell, id). Where a cell begins is in a table if the box
/// of cells that they occupy is about as large as their number, else it is looked up, so that
/// memory goes by the particles of the rank and not by the domain.
class CellOrder
{
public:
  CellOrder(const std::vector<std::array<int, 3>> &cells, const ParticleArrays &p,
            const std::array<int, 3> &n_global)
      : n_global(n_global)
  {
    first = n_global;
    std::array<int, 3> last = {{-1, -1, -1}};
    for (const auto &c : cells)
      for (unsigned int d = 0; d < 3; ++d) {
        first[d] = std::min(first[d], c[d]);
        last[d] = std::max(last[d], c[d]);
      }
    double n_cells = 1.;
    for (unsigned int d = 0; d < 3; ++d) {
      n[d] = std::max(0, last[d] - first[d] + 1);
      n_cells *= n[d];
    }
    std::vector<std::int64_t> index(cells.size());
    for (std::size_t row = 0; row < cells.size(); ++row)
      index[row] = local(cells[row]);
    rows.resize(cells.size());
    if (n_cells <= most_cells_a_particle * static_cast<double>(cells.size()))
      make_table(index, p.id, static_cast<std::size_t>(n_cells));
    else
      sort(index, p.id);
  }

  std::int64_t local(const std::array<int, 3> &c) const
  {
    return (static_cast<std::int64_t>(c[0] - first[0]) * n[1] + (c[1] - first[1])) * n[2] +
           (c[2] - first[2]);
  }

  /// Runs of particles in the cells around @p c, of those not before it, in ascending order.
  unsigned int runs_around(const std::array<int, 3> &c, const std::array<bool, 3> &periodic,
                           Run *runs) const
  {
    unsigned int count = 0;
    const std::int32_t own = start(local(c));
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy) {
        std::array<int, 3> column = {{c[0] + dx, c[1] + dy, 0}};
        if (!wrap(column, 0, periodic) || !wrap(column, 1, periodic))
          continue;
        const auto add = [&](int from, int to) {
          from = std::max(from, first[2]);
          to = std::min(to, first[2] + n[2] - 1);
          if (from > to)
            return;
          const std::int64_t base = local({{column[0], column[1], 0}});
          const Run run = {std::max(own, start(base + from)), start(base + to + 1)};
          if (run.begin < run.end)
            runs[count++] = run;
        };
        add(c[2] - 1, c[2] + 1);
        if (periodic[2] && c[2] == 0)
          add(n_global[2] - 1, n_global[2] - 1);
        if (periodic[2] && c[2] == n_global[2] - 1)
          add(0, 0);
      }
    return unite(runs, count);
  }

  /// Whether cells can be marked.
  bool has_table() const { return !table.empty(); }

  /// Marks the cells around @p c, which may lie outside of the box of cells.
  void mark_around(const std::array<int, 3> &c, const std::array<bool, 3> &periodic)
  {
    marked.resize(table.size(), 0);
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dz = -1; dz <= 1; ++dz) {
          std::array<int, 3> near = {{c[0] + dx, c[1] + dy, c[2] + dz}};
          if (wrap(near, 0, periodic) && wrap(near, 1, periodic) && wrap(near, 2, periodic))
            marked[local(near)] = 1;
        }
  }

  bool is_marked(const std::array<int, 3> &c) const
  {
    return !marked.empty() && marked[local(c)] != 0;
  }

  std::vector<std::int32_t> rows;

private:
  static constexpr double most_cells_a_particle = 16.;

  void make_table(const std::vector<std::int64_t> &index, const std::vector<ParticleId> &ids,
                  const std::size_t n_cells)
  {
    table.assign(n_cells + 1, 0);
    for (const std::int64_t cell : index)
      ++table[cell + 1];
    std::partial_sum(table.begin(), table.end(), table.begin());
    std::vector<std::int32_t> next(table.begin(), table.end() - 1);
    for (std::size_t row = 0; row < index.size(); ++row)
      rows[next[index[row]]++] = static_cast<std::int32_t>(row);
    for (std::size_t c = 0; c < n_cells; ++c)
      std::sort(rows.begin() + table[c], rows.begin() + table[c + 1],
                [&](std::int32_t a, std::int32_t b) { return ids[a] < ids[b]; });
  }

  void sort(const std::vector<std::int64_t> &index, const std::vector<ParticleId> &ids)
  {
    std::iota(rows.begin(), rows.end(), 0);
    std::sort(rows.begin(), rows.end(), [&](std::int32_t a, std::int32_t b) {
      return index[a] != index[b] ? index[a] < index[b] : ids[a] < ids[b];
    });
    for (std::size_t place = 0; place < rows.size(); ++place)
      if (occupied.empty() || occupied.back().cell != index[rows[place]])
        occupied.push_back({index[rows[place]], static_cast<std::int32_t>(place)});
  }

  /// Place of the first particle in a cell or behind it.
  std::int32_t start(const std::int64_t cell) const
  {
    if (!table.empty())
      return table[cell];
    const auto next =
        std::lower_bound(occupied.begin(), occupied.end(), cell,
                         [](const Occupied &one, std::int64_t at) { return one.cell < at; });
    return next == occupied.end() ? static_cast<std::int32_t>(rows.size()) : next->begin;
  }

  /// Moves a coordinate back into the grid; false beyond the box of cells.
  bool wrap(std::array<int, 3> &c, unsigned int d, const std::array<bool, 3> &periodic) const
  {
    if (periodic[d])
      c[d] = (c[d] + n_global[d]) % n_global[d];
    return c[d] >= first[d] && c[d] < first[d] + n[d];
  }

  struct Occupied
  {
    std::int64_t cell;
    std::int32_t begin;
  };

  std::array<int, 3> n_global, first, n;
  std::vector<std::int32_t> table;  ///< empty if starts are looked up
  std::vector<std::uint8_t> marked; ///< by cell, if some are
  std::vector<Occupied> occupied;
};

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
      const Quad &q = p.position[rows[k]];
      x[k] = q.x;
      y[k] = q.y;
      z[k] = q.z;
      radius[k] = q.w;
      id[k] = p.id[rows[k]];
    }
  }

  /// Writes the pairs of sphere @p a with those of a run that have a separation of less than
  /// @p reach and are not both ghosts: the rows of the lower ids to @p i, of the higher ones to
  /// @p j, which need room for as many as the run has and one more.
  /// @return number of pairs
  EUNOE_MULTIVERSION std::int32_t find_near(const std::size_t a, const Run &run, const double reach,
                                            const Vec3 &period, const Vec3 &half, std::int32_t *i,
                                            std::int32_t *j) const
  {
    const double ax = x[a], ay = y[a], az = z[a], radius_a = radius[a] + reach;
    const std::int32_t row_a = rows[a];
    const ParticleId id_a = id[a];
    const bool a_is_owned = row_a < n_owned;
    std::int32_t n = 0;
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
      // Without branches, which could not be foretold.
      const std::int32_t count = std::min(batch, run.end - first);
      for (std::int32_t k = 0; k < count; ++k) {
        const std::int32_t row = rows[first + k];
        const bool is_lower = id[first + k] < id_a;
        i[n] = is_lower ? row : row_a;
        j[n] = is_lower ? row_a : row;
        n += static_cast<std::int32_t>(excess[k] < 0.) &
             (static_cast<std::int32_t>(a_is_owned) | static_cast<std::int32_t>(row < n_owned));
      }
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
      const Run rest = {std::max(runs[r].begin, static_cast<std::int32_t>(place) + 1), runs[r].end};
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
  std::array<Run, 27> runs;
  unsigned int n_runs = 0;
  const std::array<int, 3> *run_cell = nullptr;
  std::vector<std::int32_t> i, j;
};

/// Lists all pairs and notes their groups.
void list_all(PairFinder &finder, const std::vector<std::int32_t> &rows, PairList &pairs,
              ContactGrid::Found *const found)
{
  if (found != nullptr)
    found->groups.resize(rows.size());
  for (std::size_t place = 0; place < rows.size(); ++place) {
    const std::size_t begin = pairs.size();
    finder.append(place, pairs);
    if (found != nullptr)
      found->groups[rows[place]] = {begin, pairs.size()};
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
    cells[row] = cell(p.position[row].vec());
  return cells;
}

std::array<bool, 3> ContactGrid::periodic_axes() const
{
  return {{box.is_periodic(axis[0]), box.is_periodic(axis[1]), box.is_periodic(axis[2])}};
}

void ContactGrid::note(std::vector<Cell> &&cells, Found *const found) const
{
  if (found != nullptr) {
    found->lower = lower;
    found->cells = std::move(cells);
  }
}

void ContactGrid::find_pairs(const ParticleArrays &p, const double reach, PairList &pairs,
                             Found *const found) const
{
  std::vector<Cell> cells = cells_of(p);
  const CellOrder order(cells, p, n);
  PairFinder finder(p, order, cells, box, periodic_axes(), reach);
  list_all(finder, order.rows, pairs, found);
  note(std::move(cells), found);
}

void ContactGrid::find_pairs_again(const ParticleArrays &p, const double reach,
                                   const std::vector<std::uint8_t> &moved, PairList &pairs,
                                   Found *const found) const
{
  const LivingContacts contacts(pairs, p.size());
  const PairList old = pairs.take_pairs();
  std::vector<Cell> cells = cells_of(p);
  CellOrder order(cells, p, n);
  const std::array<bool, 3> periodic = periodic_axes();
  PairFinder finder(p, order, cells, box, periodic, reach);
  const auto n_moved =
      std::count_if(moved.begin(), moved.end(), [](auto flag) { return flag != 0; });
  if (found == nullptr || norm_square(lower - found->lower) > 0. || !order.has_table() ||
      2 * static_cast<std::size_t>(n_moved) > p.size())
  {
    list_all(finder, order.rows, pairs, found);
    contacts.attach(pairs, 0);
    note(std::move(cells), found);
    return;
  }
  for (std::size_t row = 0; row < p.size(); ++row)
    if (moved[row] != 0) {
      order.mark_around(cells[row], periodic);
      if (cells[row] != found->cells[row])
        order.mark_around(found->cells[row], periodic);
    }
  for (std::size_t place = 0; place < order.rows.size(); ++place) {
    const std::int32_t row = order.rows[place];
    Found::Group &group = found->groups[row];
    const std::size_t begin = pairs.size();
    if (order.is_marked(cells[row])) {
      finder.append(place, pairs);
      contacts.attach(pairs, begin);
    } else
      pairs.append(old, group.begin, group.end);
    group = {begin, pairs.size()};
  }
  note(std::move(cells), found);
}

} // namespace eunoe
