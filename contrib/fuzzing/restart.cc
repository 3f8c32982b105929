// Any bytes as a checkpoint, with the right checksum, from which a case continues. The case is
// seeds/restart.prm, or what the environment's EUNOE_FUZZING_CASE names.

#include <eunoe/simulation/simulation.h>

#include "checkpoint_image.h"
#include "fuzzing.h"

namespace {

using eunoe::Parameters;

/// A name as a run gives it, as all others are passed over.
const std::string checkpoint = "restart_000000000040.checkpoint";

std::string read_text(const std::string &path)
{
  std::ostringstream all;
  all << std::ifstream(path).rdbuf();
  return all.str();
}

/// The case, in a folder of its own with a list of checkpoints that names one file.
class Case
{
public:
  Case() : folder(std::filesystem::temp_directory_path() / ("eunoe-" + std::to_string(getpid())))
  {
    const char *const chosen = std::getenv("EUNOE_FUZZING_CASE");
    path = chosen != nullptr ? chosen : EUNOE_SOURCE "/contrib/fuzzing/seeds/restart.prm";
    text = read_text(path);
    std::filesystem::create_directories(folder);
    input = read().as_input_file();
  }
  ~Case() { std::filesystem::remove_all(folder); }

  Parameters read() const
  {
    eunoe::Problems problems;
    Parameters parameters = Parameters::read(
        text, path,
        {"restart/restart = true", "simulation control/output path = " + folder.string()}, problems,
        [](const std::string &file) { return read_text(file); });
    if (!problems.empty())
      throw std::runtime_error(problems.text());
    return parameters;
  }

  void continue_from(const std::string &image) const
  {
    // The run before may have left its own.
    std::ofstream(folder / "restart.latest") << checkpoint + "\n";
    std::ofstream(folder / checkpoint, std::ios::binary) << image;
    Parameters parameters = read();
    eunoe::Log log(MPI_COMM_WORLD, true);
    try {
      eunoe::Simulation simulation(parameters, MPI_COMM_WORLD, log);
      simulation.open_output();
      unsigned int steps = 0;
      simulation.run([&steps](eunoe::Simulation &) {
        if (++steps > 3)
          throw eunoe::UserError("enough");
      });
    } catch (const eunoe::UserError &error) {
      if (std::getenv("EUNOE_FUZZING_VERBOSE") != nullptr)
        std::fprintf(stderr, "%s\n", error.what());
    }
  }

  std::string input;

private:
  const std::filesystem::path folder;
  std::string path, text;
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
  static const Case one_case;
  one_case.continue_from(fuzzing::checkpoint_image(std::string(data, data + size), one_case.input));
  return 0;
}
