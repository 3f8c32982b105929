#ifndef eunoe_core_first_rank_h
#define eunoe_core_first_rank_h

#include <functional>
#include <mpi.h>

namespace eunoe {

bool is_first_rank(MPI_Comm comm);

/// Lets the first rank do what one alone can do, as to write a file. A UserError that it meets is
/// thrown on every rank, so that none waits for one that has left; collective.
void on_first_rank(MPI_Comm comm, const std::function<void()> &action);

} // namespace eunoe

#endif
