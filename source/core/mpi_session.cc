#include <eunoe/core/mpi_session.h>

#include <deal.II/base/mpi.h>

namespace eunoe {

struct MpiSession::Libraries
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi;
};

MpiSession::MpiSession(int &argc, char **&argv) : libraries(new Libraries{{argc, argv, 1}}) {}

MpiSession::~MpiSession() = default;

} // namespace eunoe
