// The test program of a folder: runs the test named on the command line; without a known name it
// lists all tests.

#include <eunoe/core/mpi_session.h>

#include "tests.h"

#include <map>

namespace {

struct Test
{
  void (*run)();
  bool with_mpi;
};

std::map<std::string, Test> &tests()
{
  static std::map<std::string, Test> all;
  return all;
}

} // namespace

test::Registration::Registration(const char *file, void (*run)(), bool with_mpi)
{
  const std::string path = file;
  const std::size_t begin = path.rfind('/') + 1;
  tests()[path.substr(begin, path.rfind('.') - begin)] = {run, with_mpi};
}

int main(int argc, char **argv)
{
  const auto found = argc == 2 ? tests().find(argv[1]) : tests().end();
  if (found == tests().end()) {
    std::cerr << "Usage: " << argv[0] << " test, where the tests are:\n";
    for (const auto &[name, test] : tests())
      std::cerr << "  " << name << "\n";
    return 2;
  }
  if (!found->second.with_mpi) {
    found->second.run();
    return 0;
  }
  const eunoe::MpiSession mpi(argv);
  found->second.run();
}
