#ifndef eunoe_simulation_application_h
#define eunoe_simulation_application_h

#include <mpi.h>

namespace eunoe {

/// The program eunoe-particles: reads the command line and the input file, runs the case on all
/// ranks of @p comm and says what is wrong in sentences.
/// @return exit code, the same on every rank
int run_particles(int argc, char **argv, MPI_Comm comm);

} // namespace eunoe

#endif
