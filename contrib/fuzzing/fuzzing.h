#ifndef eunoe_contrib_fuzzing_h
#define eunoe_contrib_fuzzing_h

// What the fuzzers share. A fuzzer accepts a UserError, by which bad input is refused. Any other
// exception ends it like a crash.

#include <eunoe/simulation/parameters.h>

#include <deal.II/base/mpi.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <sys/mman.h>
#include <unistd.h>

namespace fuzzing {

using namespace eunoe;

/// Starts MPI, which everything else needs.
inline void start(int *argc, char ***argv)
{
  static const dealii::Utilities::MPI::MPI_InitFinalize mpi(*argc, *argv, 1);
}

/// A file that lives in memory for as long as this object.
class MemoryFile
{
public:
  MemoryFile(const void *data, std::size_t size) : descriptor(memfd_create("fuzzing", 0))
  {
    if (descriptor < 0 || ::write(descriptor, data, size) != static_cast<ssize_t>(size))
      std::abort();
  }
  ~MemoryFile() { ::close(descriptor); }

  std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor); }

private:
  const int descriptor;
};

/// Gives a file that an input includes: the input itself under the name "self", and files of the
/// source tree, to which the seeds refer.
inline FileLoader loader(const std::string &text)
{
  return [text](const std::string &path) {
    if (std::filesystem::path(path).filename() == "self")
      return text;
    if (path.rfind(EUNOE_SOURCE "/", 0) != 0 || !std::filesystem::is_regular_file(path))
      throw UserError(path + " cannot be read.");
    std::ostringstream all;
    all << std::ifstream(path).rdbuf();
    return all.str();
  };
}

/// Reads an input text as if it were a file next to the broken inputs of the tests.
inline Parameters read(const std::string &text, Problems &problems)
{
  return Parameters::read(text, EUNOE_SOURCE "/tests/bad_input/self", {}, problems, loader(text));
}

} // namespace fuzzing

/// Called by libFuzzer before all else.
extern "C" int LLVMFuzzerInitialize(int *argc, char ***argv)
{
  fuzzing::start(argc, argv);
  return 0;
}

#endif
