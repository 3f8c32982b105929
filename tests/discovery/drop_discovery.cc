// eunoe-discovery with one more process, whose runs take no time; end_to_end.py uses it.

#include <eunoe/core/mpi_session.h>
#include <eunoe/discovery/application.h>

#include "drop_process.h"

int main(int argc, char **argv)
{
  const eunoe::MpiSession mpi(argv);
  return eunoe::discovery::run_discovery(argc, argv, MPI_COMM_WORLD);
}
