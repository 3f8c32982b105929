#include <eunoe/core/departure.h>
#include <eunoe/core/exit_code.h>
#include <eunoe/core/log.h>
#include <eunoe/core/version.h>
#include <eunoe/simulation/command_line.h>

#include <boost/program_options.hpp>

#include <csignal>
#include <iostream>
#include <sstream>

namespace eunoe {

namespace po = boost::program_options;

CommandLine parse_command_line(int argc, char **argv, const ProgramText &program,
                               const std::vector<ProgramOption> &own_options)
{
  CommandLine line;
  po::options_description visible("Options");
  visible.add_options()("set", po::value<std::vector<std::string>>(&line.overrides),
                        "\"subsection/entry = value\": override an entry of the input file; may be "
                        "given several times")("check", po::bool_switch(&line.check),
                                               program.check.c_str())(
      "print-parameters", po::bool_switch(&line.print_parameters),
      ("print a complete input file with documentation and exit; with a " + program.input +
       ", its values")
          .c_str())("describe-parameters", po::bool_switch(&line.describe_parameters),
                    "print all entries with their defaults, kinds of values and documentation as "
                    "JSON and exit");
  for (const ProgramOption &option : own_options)
    visible.add_options()(option.name.c_str(),
                          option.flag != nullptr
                              ? static_cast<po::value_semantic *>(po::bool_switch(option.flag))
                              : po::value<std::string>(option.value),
                          option.text.c_str());
  visible.add_options()("quiet", po::bool_switch(&line.quiet), "print nothing but errors")(
      "version", po::bool_switch(&line.version),
      "print the version and exit")("help", po::bool_switch(&line.help), "print this and exit");
  po::options_description all;
  all.add(visible).add_options()("input", po::value<std::string>(&line.file));
  po::positional_options_description positional;
  positional.add("input", 1);
  std::ostringstream text;
  text << "Usage: " << program.name << " [options] " << program.input << "\n       mpirun -np 4 "
       << program.name << " " << program.input << "\n\n"
       << program.purpose << "\n\n"
       << visible;
  line.help_text = text.str();
  try {
    po::variables_map map;
    po::store(po::command_line_parser(argc, argv).options(all).positional(positional).run(), map);
    po::notify(map);
  } catch (const po::error &error) {
    line.error = error.what();
  }
  return line;
}

std::optional<ExitCode> answer(const CommandLine &line, const ProgramText &program,
                               const bool needs_input, MPI_Comm comm)
{
  Log log(comm, line.quiet);
  if (!line.error.empty() || (line.file.empty() && needs_input && !line.help && !line.version)) {
    Log errors(comm);
    errors.error(line.error.empty() ? "An input file is missing."
                                    : "Command line: " + line.error + ".");
    errors.error("Try " + program.name + " --help.");
    return exit_bad_input;
  }
  if (line.help) {
    log.line(line.help_text);
    return exit_success;
  }
  if (line.version) {
    log.line("Eunoe " + std::string(version()) + " (revision " + git_revision() + ", deal.II " +
             deal_ii_version() + ")");
    return exit_success;
  }
  return std::nullopt;
}

int guarded(MPI_Comm comm, const std::function<int()> &body, const double patience)
{
#ifdef SIGXFSZ
  // Where the size of files is limited, writing shall fail with a sentence instead.
  std::signal(SIGXFSZ, SIG_IGN);
#endif
  const Departure departure(comm);
  try {
    return body();
  } catch (const RefusedInput &error) {
    departure.leave(error.what(), patience);
    return exit_bad_input;
  } catch (const UserError &error) {
    departure.leave(error.what(), patience);
    return exit_failure;
  } catch (const std::exception &error) {
    // Only this rank knows, and the others wait for it.
    std::cerr << "Internal error: " << error.what() << std::endl;
    MPI_Abort(comm, exit_failure);
    return exit_failure;
  }
}

} // namespace eunoe
