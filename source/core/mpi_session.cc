#include <eunoe/core/mpi_session.h>

#include <deal.II/base/mpi.h>

#include <cstdlib>

namespace eunoe {

struct MpiSession::Libraries
{
  explicit Libraries(char **&argv) : mpi(n_arguments, argv, 1) {}

  /// Ranks of one node send each other a few kB of ghosts at every step. Open MPI copies so much
  /// without asking the receiver first only if it is told to, before it begins; its limit is 4 kB.
  /// What the user has set stays, and other MPI libraries do not read it.
  struct SendsAtOnce
  {
    SendsAtOnce()
    {
      for (const char *limit : {"OMPI_MCA_btl_vader_eager_limit", "OMPI_MCA_btl_sm_eager_limit"})
        setenv(limit, "32768", 0);
    }
  };

  SendsAtOnce setting;
  /// deal.II hands the arguments on to PETSc, which would complain in the output of those that it
  /// does not know: the name of the program is all that it gets.
  int n_arguments = 1;
  dealii::Utilities::MPI::MPI_InitFinalize mpi;
};

MpiSession::MpiSession(char **argv) : libraries(new Libraries(argv)) {}

MpiSession::~MpiSession() = default;

} // namespace eunoe
