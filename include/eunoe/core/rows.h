#ifndef eunoe_core_rows_h
#define eunoe_core_rows_h

#include <cstdint>
#include <functional>
#include <list>
#include <mpi.h>
#include <vector>

namespace eunoe {

/// Rows of doubles, each of its own length, one behind the other.
struct Rows
{
  std::vector<std::size_t> starts = {0}; ///< of the rows among the values, and the end
  std::vector<double> values;

  std::size_t size() const { return starts.size() - 1; }
  std::size_t length(std::size_t row) const { return starts[row + 1] - starts[row]; }
  const double *operator[](std::size_t row) const { return values.data() + starts[row]; }

  void append(const double *begin, const double *end)
  {
    values.insert(values.end(), begin, end);
    starts.push_back(values.size());
  }
};

/// Rows in an order of their own, wherever they lie.
class RowViews
{
public:
  RowViews() = default;
  /// All rows, which must outlive the views.
  explicit RowViews(const Rows &rows)
  {
    for (std::size_t row = 0; row < rows.size(); ++row)
      add(rows[row], rows.length(row));
  }

  RowViews(RowViews &&) = default;
  RowViews &operator=(RowViews &&) = default;

  std::size_t size() const { return views.size(); }
  std::size_t length(std::size_t row) const { return views[row].length; }
  const double *operator[](std::size_t row) const { return views[row].begin; }
  const double *end(std::size_t row) const { return views[row].begin + views[row].length; }
  /// Of all rows.
  std::size_t n_values() const
  {
    std::size_t n = 0;
    for (const View &view : views)
      n += view.length;
    return n;
  }

  Rows copy() const
  {
    Rows rows;
    for (std::size_t row = 0; row < size(); ++row)
      rows.append((*this)[row], end(row));
    return rows;
  }

  void reserve(std::size_t n) { views.reserve(n); }
  void add(const double *begin, std::size_t length) { views.push_back({begin, length}); }
  /// Keeps values to which views point.
  const std::vector<double> &own(std::vector<double> &&values)
  {
    owned.push_back(std::move(values));
    return owned.back();
  }

private:
  struct View
  {
    const double *begin;
    std::size_t length;
  };
  std::vector<View> views;
  std::list<std::vector<double>> owned;
};

/// Rows in the order of their keys.
struct SortedRows
{
  std::vector<std::uint32_t> keys;
  RowViews rows;
};

/// Brings rows into the order of their keys, over all ranks: the first rank gets the first ones,
/// and all about as many. No rank sees the keys of all; collective.
/// @param keys different from each other on all ranks
/// @param most_direct number of ranks up to which each has all others for partners; with more they
///                    are joined by SquareRoutes
SortedRows sort_rows(const std::vector<std::uint32_t> &keys, Rows &&rows, MPI_Comm comm,
                     int most_direct = 256);

/// Where a row is kept among all ranks.
struct Origin
{
  std::int32_t rank = -1; ///< -1: there is none, which counts as an empty row
  std::int32_t row = 0;
};

/// Fetches rows from where they are kept, in the order asked for; collective.
/// @param kept this rank's rows, which must outlive the result
RowViews fetch_rows(const Rows &kept, const std::vector<Origin> &origins, MPI_Comm comm);

/// Fetches rows of @p n_values doubles from the other ranks that have them, in the order asked for;
/// collective.
/// @param pack appends such a row of this rank
std::vector<double> fetch_foreign(
    const std::vector<Origin> &origins, std::size_t n_values,
    const std::function<void(std::int32_t row, std::vector<double> &values)> &pack, MPI_Comm comm);

} // namespace eunoe

#endif
