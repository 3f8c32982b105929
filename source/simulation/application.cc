#include <eunoe/core/exit_code.h>
#include <eunoe/core/files.h>
#include <eunoe/simulation/command_line.h>
#include <eunoe/simulation/simulation.h>

namespace eunoe {

namespace {

const ProgramText program = {
    "eunoe-particles", "case.prm",
    "Simulates powders by the discrete element method as the input file says.",
    "read and check the case, say what would run (particles, memory, steps, core-hours) and what "
    "is doubtful, run nothing"};

void print_check(const RunEstimate &estimate, const double time_step, const std::size_t n_warnings,
                 Log &log)
{
  log.line("It would run with");
  log.line("  particles:  " + format_whole(estimate.most_particles) + " at most, " +
           format_whole(estimate.particles) + " on average");
  log.line("  steps:      " + format_whole(estimate.steps) + " of " + format(time_step) + " s");
  log.line("  core-hours: about " + format_roughly(estimate.core_seconds() / 3600.) + " (" +
           format(estimate.particle_steps()) + " particle-steps at " +
           format(estimate.speed() / 1e6) + " million a second and core)");
  log.line(n_warnings == 0
               ? "The case is in order."
               : "The case can be run. " + count_of_warnings(n_warnings) + ": see above.");
}

int run(const CommandLine &line, const std::string &dump, MPI_Comm comm)
{
  if (const auto code =
          answer(line, program, !line.print_parameters && !line.describe_parameters, comm))
    return *code;
  Log log(comm, line.quiet);
  if (line.describe_parameters) {
    log.line(Parameters::description());
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
    const Forecast forecast = simulation->foresee();
    forecast.print(log);
    if (!forecast.problems.empty())
      throw UserError(forecast.problems);
    if (line.check) {
      print_check(simulation->estimate(), simulation->time_step(),
                  problems.warnings().size() + forecast.problems.warnings().size(), log);
      return exit_success;
    }
    simulation->open_output();
  } catch (const UserError &error) {
    throw RefusedInput(error);
  }
  const bool complete = simulation->run();
  if (!dump.empty())
    simulation->dump(dump);
  return complete ? exit_success : exit_stopped;
}

} // namespace

int run_particles(int argc, char **argv, MPI_Comm comm)
{
  return guarded(comm, [&] {
    std::string dump, seed;
    CommandLine line = parse_command_line(
        argc, argv, program,
        {{"dump",
          "at the end, write the complete state to this file, which is the same on any number of "
          "ranks",
          nullptr, &dump},
         {"seed",
          "seed of all random numbers, as the entry 'seed' in subsection 'simulation control'",
          nullptr, &seed}});
    if (!seed.empty())
      line.overrides.push_back("simulation control/seed = " + seed);
    return run(line, dump, comm);
  });
}

} // namespace eunoe
