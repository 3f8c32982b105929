#ifndef eunoe_core_mpi_session_h
#define eunoe_core_mpi_session_h

#include <memory>

namespace eunoe {

/// MPI and the libraries that need it, from the beginning of a program to its end. A program's
/// main() makes one. One thread a rank.
class MpiSession
{
public:
  /// @param argv of main()
  explicit MpiSession(char **argv);
  ~MpiSession();

private:
  struct Libraries;
  const std::unique_ptr<Libraries> libraries;
};

} // namespace eunoe

#endif
