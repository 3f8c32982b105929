#ifndef eunoe_core_rows_h
#define eunoe_core_rows_h

#include <cstdint>
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

/// Where a row is kept among all ranks.
struct Origin
{
  std::int32_t rank = -1; ///< -1: there is none, which counts as an empty row
  std::int32_t row = 0;
};

/// Fetches rows from where they are kept, in the order asked for; collective.
/// @param kept this rank's rows
Rows fetch_rows(const Rows &kept, const std::vector<Origin> &origins, MPI_Comm comm);

} // namespace eunoe

#endif
