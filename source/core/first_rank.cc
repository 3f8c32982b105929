#include <eunoe/core/files.h>
#include <eunoe/core/first_rank.h>
#include <eunoe/core/problems.h>

namespace eunoe {

bool is_first_rank(MPI_Comm comm)
{
  int rank;
  MPI_Comm_rank(comm, &rank);
  return rank == 0;
}

void on_first_rank(MPI_Comm comm, const std::function<void()> &action)
{
  on_every_rank(comm, [&] {
    if (is_first_rank(comm))
      action();
  });
}

void on_every_rank(MPI_Comm comm, const std::function<void()> &action)
{
  int rank, n_ranks;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &n_ranks);
  std::string error;
  int first = n_ranks;
  try {
    action();
  } catch (const UserError &problem) {
    error = problem.what();
    first = rank;
  }
  MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, comm);
  if (first < n_ranks)
    throw UserError(broadcast(error, comm, first));
}

} // namespace eunoe
