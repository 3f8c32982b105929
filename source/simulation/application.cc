#include <eunoe/core/exit_code.h>
#include <eunoe/core/files.h>
#include <eunoe/simulation/command_line.h>
#include <eunoe/simulation/given_particles.h>
#include <eunoe/simulation/simulation.h>

#include <boost/algorithm/string.hpp>

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

/// What only this program is asked for.
struct ExtraArguments
{
  std::string dump, measure;
};

/// Prints what the case's process measures of particles in files.
void measure(const Parameters &parameters, const std::string &files, MPI_Comm comm, Log &log)
{
  const ProcessSection *const process = parameters.process();
  if (process == nullptr)
    throw UserError(
        "--measure: the case has no process, so that nothing says what is measured. Set "
        "the entry 'process'.");
  std::vector<std::string> names;
  boost::split(names, files, boost::is_any_of(","));
  std::vector<std::vector<GivenParticle>> moments;
  const ParticleType &powder = parameters.physics.types.at(process->powder());
  for (std::string &name : names) {
    boost::trim(name);
    moments.push_back(read_given_particles(name, powder, comm));
  }
  std::string table;
  try {
    table = table_of(process->measure(parameters, moments), process->observables());
  } catch (const UserError &error) {
    throw UserError(files + ": " + error.what());
  }
  boost::trim_right(table);
  log.line(table);
}

int run(const CommandLine &line, const ExtraArguments &arguments, MPI_Comm comm)
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
    if (!arguments.measure.empty()) {
      measure(parameters, arguments.measure, comm, log);
      return exit_success;
    }
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
  if (!arguments.dump.empty())
    simulation->dump(arguments.dump);
  return complete ? exit_success : exit_stopped;
}

} // namespace

int run_particles(int argc, char **argv, MPI_Comm comm)
{
  return guarded(comm, [&] {
    ExtraArguments arguments;
    std::string seed;
    CommandLine line = parse_command_line(
        argc, argv, program,
        {{"dump",
          "at the end, write the complete state to this file, which is the same on any number of "
          "ranks",
          nullptr, &arguments.dump},
         {"measure",
          "instead of a run, print what the case's process measures of the particles in this table "
          "(columns x, y, z, diameter), which are another program's or a scan's; for several "
          "layers "
          "a list of files with commas between",
          nullptr, &arguments.measure},
         {"seed",
          "seed of all random numbers, as the entry 'seed' in subsection 'simulation control'",
          nullptr, &seed}});
    if (!seed.empty())
      line.overrides.push_back("simulation control/seed = " + seed);
    return run(line, arguments, comm);
  });
}

} // namespace eunoe
