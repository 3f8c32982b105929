#ifndef eunoe_tests_on_one_rank_h
#define eunoe_tests_on_one_rank_h

// Compares the results of all ranks together with those of one rank alone, to the last bit. The
// comparison is made within the test: recorded digits would depend on the mathematical functions of
// the processor, as DEM is chaotic.

#include "tests.h"

#include <functional>
#include <vector>

namespace test {

using Numbers = std::vector<std::vector<double>>;

/// On several ranks, checks that they find the same numbers together as the first rank alone.
/// @param name of the check, whose line is not printed on a single rank
/// @param find runs a case on the ranks of a communicator
/// @return the numbers of all ranks together
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
