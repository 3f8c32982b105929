// The queue of tasks: each is done once, on one group, whatever the ranks; a stop reaches all.

#include <eunoe/core/files.h>
#include <eunoe/discovery/simulator.h>
#include <eunoe/discovery/work_queue.h>

#include "../tests.h"

#include <numeric>

EUNOE_MPI_TEST()
{
  using namespace test;
  using namespace eunoe::discovery;
  int size;
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  for (const unsigned int ranks_per_task : {1u, 2u, 5u}) {
    WorkQueue queue(MPI_COMM_WORLD, ranks_per_task);
    check("groups", queue.n_groups() == std::max(1, size / static_cast<int>(ranks_per_task)));
    for (const int n : {0, 1, 7}) {
      std::vector<int> done(static_cast<std::size_t>(n), 0);
      int finished = 0;
      queue.run(
          n,
          [&](const int k) {
            queue.serve();
            done[static_cast<std::size_t>(k)] += queue.is_leader() ? 1 : 0;
          },
          [&](const int number) { finished = number; });
      MPI_Allreduce(MPI_IN_PLACE, done.data(), n, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
      check("each of " + std::to_string(n) + " once",
            std::all_of(done.begin(), done.end(), [](int d) { return d == 1; }));
      if (is_first_rank())
        check("all were reported", finished == n);
    }
    int begun = 0;
    bool stopped = false;
    try {
      queue.run(
          1000,
          [&](const int k) {
            begun += queue.is_leader() ? 1 : 0;
            if (k == 2)
              throw Interrupted();
          },
          [](int) {});
    } catch (const Interrupted &) {
      stopped = true;
    }
    MPI_Allreduce(MPI_IN_PLACE, &begun, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
    int everywhere = stopped ? 1 : 0;
    MPI_Allreduce(MPI_IN_PLACE, &everywhere, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
    check("a stop reaches all ranks", everywhere == 1);
    check("and ends the handing out", begun < 1000);
  }
  check("texts in order",
        concatenate(std::to_string(size), MPI_COMM_WORLD).size() == static_cast<std::size_t>(size));
}
