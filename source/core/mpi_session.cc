#include <eunoe/core/mpi_session.h>

#include <deal.II/base/mpi.h>

#include <cstdlib>

namespace eunoe {

struct MpiSession::Libraries
{
  Libraries(int &argc, char **&argv) : mpi(argc, argv, 1) {}

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
  dealii::Utilities::MPI::MPI_InitFinalize mpi;
};

MpiSession::MpiSession(int &argc, char **&argv) : libraries(new Libraries(argc, argv)) {}

MpiSession::~MpiSession() = default;

} // namespace eunoe
