#ifndef eunoe_core_sparse_exchange_h
#define eunoe_core_sparse_exchange_h

#include <map>
#include <mpi.h>

namespace eunoe {

/// Tells each rank a number and returns what others tell this one, by rank; collective. The work
/// grows with the ranks that have something to tell, not with all.
std::map<int, int> numbers_from(const std::map<int, int> &numbers_to, MPI_Comm comm);

} // namespace eunoe

#endif
