#include <eunoe/application.h>
#include <eunoe/core/files.h>
#include <eunoe/core/version.h>
#include <eunoe/simulation/simulation.h>

#include <boost/program_options.hpp>

#include <iostream>
#include <sstream>

namespace eunoe {

namespace {

namespace po = boost::program_options;

struct CommandLine
{
  std::string file;
  std::vector<std::string> overrides;
  std::string dump;
  bool check = false, print_parameters = false, help = false, version = false, quiet = false;
  std::string help_text, error;
};

CommandLine parse_command_line(int argc, char **argv)
{
  CommandLine line;
  po::options_description visible("Options");
  visible.add_options()("set", po::value<std::vector<std::string>>(&line.overrides),
                        "\"subsection/entry = value\": override an entry of the input file; may be "
                        "given several times")(
      "check", po::bool_switch(&line.check),
      "read and check the case, say what would run (particles, memory, steps, core-hours), run "
      "nothing")(
      "print-parameters", po::bool_switch(&line.print_parameters),
      "print a complete input file with documentation and exit; with a case, its values")(
      "dump", po::value<std::string>(&line.dump),
      "at the end, write the complete state to this file, which is the same on any number of "
      "ranks")("quiet", po::bool_switch(&line.quiet), "print nothing but errors")(
      "version", po::bool_switch(&line.version),
      "print the version and exit")("help", po::bool_switch(&line.help), "print this and exit");
  po::options_description all;
  all.add(visible).add_options()("input", po::value<std::string>(&line.file));
  po::positional_options_description positional;
  positional.add("input", 1);
  std::ostringstream text;
  text << "Usage: eunoe-particles [options] case.prm\n       mpirun -np 4 eunoe-particles "
          "case.prm\n\n"
          "Simulates powders by the discrete element method as the input file says.\n\n"
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

void print_check(const RunEstimate &estimate, const double time_step, Log &log)
{
  // Measured on a settled bed of 20,000 to 200,000 particles with the full model.
  constexpr double bytes_per_particle = 1500., particle_steps_per_core_second = 7e6;
  const double particle_steps = estimate.particles * estimate.steps;
  const double core_seconds = particle_steps / particle_steps_per_core_second;
  log.line("The case is in order. It would run with");
  log.line("  particles:  " + format(estimate.most_particles) + " at most, " +
           format(estimate.particles) + " on average");
  log.line("  memory:     about " + format(estimate.most_particles * bytes_per_particle / 1e6) +
           " MB for the particles, and 200 MB a rank");
  log.line("  steps:      " + format(estimate.steps) + " of " + format(time_step) + " s");
  log.line("  core-hours: about " + format(core_seconds / 3600.) + " (" + format(particle_steps) +
           " particle-steps at 7 million a second and core)");
}

int run(const CommandLine &line, MPI_Comm comm)
{
  Log log(comm, line.quiet);
  Log errors(comm);
  if (!line.error.empty() ||
      (line.file.empty() && !line.help && !line.version && !line.print_parameters))
  {
    errors.error(line.error.empty() ? "An input file is missing."
                                    : "Command line: " + line.error + ".");
    errors.error("Try eunoe-particles --help.");
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

  Problems problems;
  Parameters parameters;
  std::unique_ptr<Simulation> simulation;
  try {
    const std::string text = line.file.empty() ? "" : read_file(line.file, comm);
    parameters =
        Parameters::read(text, line.file.empty() ? "--set" : line.file, line.overrides, problems,
                         [comm](const std::string &path) { return read_file(path, comm); });
    if (problems.empty() && line.print_parameters) {
      log.line(parameters.as_input_file());
      return exit_success;
    }
    if (!problems.empty())
      throw UserError(problems);
    for (const Problem &warning : problems.warnings())
      log.warning(warning.text());
    // Building the parts finds what reading alone cannot; it writes nothing.
    simulation = std::make_unique<Simulation>(parameters, comm, log);
    if (line.check) {
      print_check(simulation->estimate(), simulation->time_step(), log);
      return exit_success;
    }
    simulation->open_output();
  } catch (const UserError &error) {
    errors.error(error.what());
    return exit_bad_input;
  }
  const bool complete = simulation->run();
  if (!line.dump.empty())
    simulation->dump(line.dump);
  return complete ? exit_success : exit_stopped;
}

} // namespace

int run_particles(int argc, char **argv, MPI_Comm comm)
{
  try {
    return run(parse_command_line(argc, argv), comm);
  } catch (const UserError &error) {
    // Thrown on every rank alike, so all can leave in good order.
    Log(comm).error(error.what());
    return exit_failure;
  } catch (const std::exception &error) {
    // Only this rank knows, and the others wait for it.
    std::cerr << "Internal error: " << error.what() << std::endl;
    MPI_Abort(comm, exit_failure);
    return exit_failure;
  }
}

} // namespace eunoe
