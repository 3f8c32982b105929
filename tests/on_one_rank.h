#ifndef eunoe_tests_on_one_rank_h
#define eunoe_tests_on_one_rank_h

// Whether all ranks together compute what one computes alone, to the last bit. The comparison is
// made within the test, as chaos makes recorded digits depend on the mathematical functions of the
// processor.

#include "tests.h"

#include <functional>
#include <vector>

namespace test {

using Numbers = std::vector<std::vector<double>>;

/// On several ranks: whether they find the same numbers together as the first alone.
/// @param name of the line that says so; none is printed on a single rank
/// @param find runs a case on the ranks that it is given
/// @return what all ranks have found together
inline Numbers same_on_one_rank(const std::string &name,
                                const std::function<Numbers(MPI_Comm)> &find)
{
  const Numbers together = find(MPI_COMM_WORLD);
  int n_ranks = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
  if (n_ranks == 1)
    return together;
  Numbers alone;
  if (is_first_rank())
    alone = find(MPI_COMM_SELF);
  check(name + ": the same bits on one rank", !alone.empty() && together == alone);
  MPI_Barrier(MPI_COMM_WORLD);
  return together;
}

} // namespace test

#endif
