#ifndef eunoe_application_h
#define eunoe_application_h

#include <mpi.h>

namespace eunoe {

/// Exit codes of the programs.
enum ExitCode
{
  exit_success = 0,
  exit_failure = 1,   ///< the run broke off
  exit_bad_input = 2, ///< the input was refused; nothing was run or written
  exit_stopped = 3,   ///< the run was asked to stop and has left a checkpoint
};

/// The program eunoe-particles: reads the command line and the input file, runs the case on all
/// ranks of @p comm and says what is wrong in sentences.
/// @return exit code, the same on every rank
int run_particles(int argc, char **argv, MPI_Comm comm);

} // namespace eunoe

#endif
