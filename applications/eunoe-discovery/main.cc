#include <eunoe/core/mpi_session.h>
#include <eunoe/discovery/application.h>

int main(int argc, char **argv)
{
  const eunoe::MpiSession mpi(argv);
  return eunoe::discovery::run_discovery(argc, argv, MPI_COMM_WORLD);
}
