#include <eunoe/discovery/application.h>

#include <deal.II/base/mpi.h>

int main(int argc, char **argv)
{
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  return eunoe::discovery::run_discovery(argc, argv, MPI_COMM_WORLD);
}
