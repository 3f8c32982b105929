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
  std::string error;
  if (is_first_rank(comm))
    try {
      action();
    } catch (const UserError &problem) {
      error = problem.what();
    }
  error = broadcast(error, comm);
  if (!error.empty())
    throw UserError(error);
}

} // namespace eunoe
