// Runs eunoe-particles many times in one process, for tests with hundreds of inputs: starting the
// program takes longer than checking an input. Each line of the input is a run: a folder and the
// words of the command line, separated by tabs. The answer is a line with the exit code, or -1 if
// the codes of the ranks differ. The output of rank r is in the files r.out and r.err.
// tests/many_runs.py starts this program.
//
// Usage: many-runs folder

#include <eunoe/core/mpi_session.h>
#include <eunoe/simulation/application.h>

#include <fcntl.h>
#include <filesystem>
#include <iostream>
#include <mpi.h>
#include <string>
#include <unistd.h>
#include <vector>

namespace {

/// Sends one of the standard streams to a file, until it is destroyed.
class Redirection
{
public:
  Redirection(int stream, const std::string &name) : stream(stream), before(::dup(stream))
  {
    const int file = ::open(name.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    ::dup2(file, stream);
    ::close(file);
  }
  ~Redirection()
  {
    std::cout.flush();
    ::dup2(before, stream);
    ::close(before);
  }

private:
  const int stream, before;
};

/// @return exit code
int run(const std::string &line, const std::string &files)
{
  std::vector<std::string> words(1);
  for (const char c : line)
    if (c == '\t')
      words.emplace_back();
    else
      words.back() += c;
  std::filesystem::current_path(words[0]);
  words[0] = "eunoe-particles";
  std::vector<char *> arguments;
  for (std::string &word : words)
    arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const Redirection out(STDOUT_FILENO, files + ".out"), err(STDERR_FILENO, files + ".err");
  return eunoe::run_particles(static_cast<int>(words.size()), arguments.data(), MPI_COMM_WORLD);
}

} // namespace

int main(int, char **argv)
{
  const eunoe::MpiSession mpi(argv);
  int rank;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  const std::string files = std::filesystem::absolute(argv[1]) / std::to_string(rank);
  for (std::string line;;) {
    if (rank == 0 && !std::getline(std::cin, line))
      line.clear();
    int length = static_cast<int>(line.size());
    MPI_Bcast(&length, 1, MPI_INT, 0, MPI_COMM_WORLD);
    if (length == 0)
      return 0;
    line.resize(static_cast<std::size_t>(length));
    MPI_Bcast(line.data(), length, MPI_CHAR, 0, MPI_COMM_WORLD);
    const int code = run(line, files);
    int least_and_most[] = {code, -code};
    MPI_Allreduce(MPI_IN_PLACE, least_and_most, 2, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
    if (rank == 0)
      std::cout << (least_and_most[0] == -least_and_most[1] ? code : -1) << std::endl;
  }
}
