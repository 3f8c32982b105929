#include <eunoe/core/mpi_session.h>
#include <eunoe/simulation/application.h>

int main(int argc, char **argv)
{
  const eunoe::MpiSession mpi(argv);
  return eunoe::run_particles(argc, argv, MPI_COMM_WORLD);
}
