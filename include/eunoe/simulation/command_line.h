#ifndef eunoe_simulation_command_line_h
#define eunoe_simulation_command_line_h

#include <eunoe/core/problems.h>
#include <eunoe/simulation/application.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace eunoe {

class Log;

/// An option that only one of the programs has; a flag or a text, as the pointer that is given.
struct ProgramOption
{
  std::string name, text;
  bool *flag = nullptr;
  std::string *value = nullptr;
};

/// What a program says of itself in its help.
struct ProgramText
{
  std::string name;  ///< "eunoe-particles"
  std::string input; ///< what it reads: "case.prm"
  std::string purpose;
  std::string check; ///< what `--check` says of the input
};

/// The command line that all programs understand.
struct CommandLine
{
  std::string file;
  std::vector<std::string> overrides;
  bool check = false, print_parameters = false, describe_parameters = false;
  bool help = false, version = false, quiet = false;
  std::string help_text, error;
};

CommandLine parse_command_line(int argc, char **argv, const ProgramText &program,
                               const std::vector<ProgramOption> &own_options);

/// Deals with a bad command line, a missing input, `--help` and `--version`.
/// @param needs_input whether the program cannot do what was asked without an input file
/// @return the exit code if there is nothing else to do
std::optional<ExitCode> answer(const CommandLine &line, const ProgramText &program,
                               bool needs_input, MPI_Comm comm);

/// Thrown by the body of a program where the input is refused before anything is run.
class RefusedInput : public UserError
{
public:
  explicit RefusedInput(const UserError &error) : UserError(error) {}
};

/// Runs the body of a program and turns what it throws into a sentence and an exit code. A rank
/// that throws while others go on ends them all.
/// @param patience how long it waits for the others (s)
int guarded(MPI_Comm comm, const std::function<int()> &body, double patience = 10.);

} // namespace eunoe

#endif
