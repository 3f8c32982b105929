#ifndef eunoe_source_contact_cell_order_h
#define eunoe_source_contact_cell_order_h

#include <eunoe/state/particle_arrays.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <vector>

namespace eunoe {

/// A run of neighbouring cells, as places in the order of particles: [begin, end).
struct CellRun
{
  std::int32_t begin, end;
};

/// Sorts runs and unites those that overlap (a period of one or two cells meets itself).
inline unsigned int unite(CellRun *runs, unsigned int n)
{
  std::sort(runs, runs + n, [](const CellRun &a, const CellRun &b) { return a.begin < b.begin; });
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
                           CellRun *runs) const
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
          const CellRun run = {std::max(own, start(base + from)), start(base + to + 1)};
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

} // namespace eunoe

#endif
