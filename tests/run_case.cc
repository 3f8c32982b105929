// Runs an input file quietly and prints the particles at the end, in micrometres and millimetres
// per second so that small differences show. It runs the tests that consist of a .prm file.

#include <eunoe/core/files.h>
#include <eunoe/core/mpi_session.h>

#include "tests.h"

int main(int, char **argv)
{
  const eunoe::MpiSession mpi(argv);
  try {
    test::Case test_case(eunoe::read_file(argv[1], MPI_COMM_WORLD));
    test_case.run();
    test::print("id x y z radius (um) vx vy vz (mm/s) wx wy wz (rad/s)");
    const double unit[] = {1., 1e6, 1e6, 1e6, 1e6, 1e3, 1e3, 1e3, 1., 1., 1.};
    for (const auto &row : test::particle_table(*test_case)) {
      std::string line;
      for (std::size_t c = 0; c < row.size(); ++c)
        line += (c > 0 ? " " : "") + eunoe::format(unit[c] * row[c]);
      test::print(line);
    }
  } catch (const eunoe::UserError &error) {
    test::print(error.what());
  }
  return 0;
}
