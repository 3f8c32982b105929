#include <eunoe/simulation/application.h>

int main(int argc, char **argv)
{
  MPI_Init(&argc, &argv);
  const int code = eunoe::run_particles(argc, argv, MPI_COMM_WORLD);
  MPI_Finalize();
  return code;
}
