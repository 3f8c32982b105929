#include <eunoe/core/sparse_exchange.h>

#include <deal.II/base/mpi.h>

namespace eunoe {

std::map<int, int> numbers_from(const std::map<int, int> &numbers_to, MPI_Comm comm)
{
  const std::map<unsigned int, int> to(numbers_to.begin(), numbers_to.end());
  const std::map<unsigned int, int> from = dealii::Utilities::MPI::some_to_some(comm, to);
  return {from.begin(), from.end()};
}

} // namespace eunoe
