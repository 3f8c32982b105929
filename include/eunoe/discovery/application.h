#ifndef eunoe_discovery_application_h
#define eunoe_discovery_application_h

#include <mpi.h>

namespace eunoe::discovery {

/// The program eunoe-discovery: reads the command line and the study, makes it on all ranks of
/// @p comm, or makes data of a hidden truth.
/// @return exit code, the same on every rank: an ExitCode, or that of the verdict if it is asked
/// for
int run_discovery(int argc, char **argv, MPI_Comm comm);

} // namespace eunoe::discovery

#endif
