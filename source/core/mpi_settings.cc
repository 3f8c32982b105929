#include <eunoe/core/mpi_settings.h>

#include <cstdlib>

namespace eunoe {

void choose_mpi_settings()
{
  // Open MPI guards a pointer into each shared file, which nobody here uses, with a semaphore that
  // is named after the file and belongs to the whole machine. A run that is killed while it opens a
  // picture leaves it locked, and every later run would wait for it for ever. This choice offers no
  // such pointer at all; others would make files for their locks beside the pictures.
  setenv("OMPI_MCA_sharedfp", "individual", 0);
}

} // namespace eunoe
