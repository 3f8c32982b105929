#include <eunoe/simulation/application.h>

#include <deal.II/base/mpi.h>

int main(int argc, char **argv)
{
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  return eunoe::run_particles(argc, argv, MPI_COMM_WORLD);
}
