#ifndef eunoe_core_first_rank_h
#define eunoe_core_first_rank_h

#include <functional>
#include <mpi.h>

namespace eunoe {

bool is_first_rank(MPI_Comm comm);

/// Runs an action on the first rank only, such as writing a file. A UserError there is thrown on
/// every rank, so that none waits for a rank that has left; collective.
void on_first_rank(MPI_Comm comm, const std::function<void()> &action);

/// Runs an action without messages on every rank. A UserError of one is thrown on all, that of the
/// first of them; collective.
void on_every_rank(MPI_Comm comm, const std::function<void()> &action);

} // namespace eunoe

#endif
