// A program in which some ranks throw while the others wait for them; lone_error.py runs it.
// Usage: lone-error RANK ...

#include <eunoe/core/exit_code.h>
#include <eunoe/simulation/command_line.h>

#include <algorithm>
#include <mpi.h>
#include <string>

int main(int argc, char **argv)
{
  MPI_Init(&argc, &argv);
  int rank;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  const bool throws = std::any_of(
      argv + 1, argv + argc, [rank](const std::string &word) { return std::stoi(word) == rank; });
  constexpr double patience = 0.5; // s
  const int code = eunoe::guarded(
      MPI_COMM_WORLD,
      [throws]() -> int {
        if (throws)
          throw eunoe::UserError("The file is not here.");
        MPI_Barrier(MPI_COMM_WORLD);
        return eunoe::exit_success;
      },
      patience);
  MPI_Finalize();
  return code;
}
