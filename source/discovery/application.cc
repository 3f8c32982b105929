#include <eunoe/core/exit_code.h>
#include <eunoe/core/files.h>
#include <eunoe/core/first_rank.h>
#include <eunoe/core/machine.h>
#include <eunoe/core/quoted_text.h>
#include <eunoe/core/stop_request.h>
#include <eunoe/discovery/application.h>
#include <eunoe/discovery/measured_csv.h>
#include <eunoe/discovery/results.h>
#include <eunoe/discovery/synthetic_data.h>
#include <eunoe/discovery/tuned.h>
#include <eunoe/simulation/command_line.h>
#include <eunoe/simulation/forecast.h>

#include <boost/algorithm/string.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>

namespace eunoe::discovery {

namespace {

const ProgramText program = {
    "eunoe-discovery", "study.prm",
    "Compares a model with measured data, and says whether an effect is missing and which one.",
    "read and check the study, say what would run (experiments, effects, runs, core-hours) and "
    "what is doubtful, run nothing"};

struct ExtraArguments
{
  bool list_observables = false, list_effects = false, plan = false, fill_table = false,
       verdict_exit_code = false;
  std::string truth_file;
};

void list_observables(Log &log)
{
  for (const std::string &name : process_kinds().list()) {
    log.line("process '" + name + "':");
    for (const ObservableDescription &o : process_kinds().make(name)->observables())
      log.line("  " + o.name + " (" + o.unit + "): " + o.text +
               (o.index_meaning.empty() ? "" : "; index: " + o.index_meaning));
  }
}

std::string word_for(const Factor::Sign sign)
{
  return sign == Factor::Sign::above ? "above" : sign == Factor::Sign::below ? "below" : "both";
}

void list_effects(const std::vector<Effect> &effects, Log &log)
{
  for (const Effect &f : effects) {
    if (f.kind != Factor::Kind::effect)
      continue;
    const std::string others = boost::join(f.confounders, ", ");
    log.line(f.name + ": " + f.mechanism + "\n  amplitude: " + f.parameter + " (" + f.unit +
             "), null value " + format(f.null_value) + ", scale " + format(f.scale) + ", range " +
             format(f.lower) + " to " + format(f.upper) + "; sign: " + word_for(f.sign) +
             "; confounders: " + (others.empty() ? "none" : others) + "; process: " + f.process);
  }
}

void refuse_if_any(const Problems &problems)
{
  if (!problems.empty())
    throw UserError(problems);
}

/// Prints the warnings about a study, for `--check` and for the start of the study.
/// @return number of warnings
std::size_t print_doubts(const StudyInput &study, const Problems &problems, Log &log)
{
  std::size_t n = problems.warnings().size();
  for (const Problem &doubt : problems.warnings())
    log.warning(doubt.text());
  for (const Experiment &experiment : study.experiments) {
    n += experiment.doubts().size();
    for (const Problem &doubt : experiment.doubts())
      log.warning("Experiment '" + experiment.name() + "': " + doubt.text());
  }
  return n;
}

/// Prints what a study would cost, for `--check`.
void print_check(const StudyInput &study, const std::size_t n_warnings, Log &log)
{
  const StudyOptions &options = study.parameters.options;
  std::string names;
  double n_effects = 0., n_nuisances = 0.;
  for (const Effect &effect : study.factors) {
    names += (names.empty() ? "" : ", ") + effect.name;
    (effect.kind == Factor::Kind::effect ? n_effects : n_nuisances) += 1.;
  }
  double runs = 0., core_hours = 0.;
  std::uint64_t of_base = 0; // without which there is no study
  for (const Experiment &experiment : study.experiments) {
    double n_points = 0.;
    for (const auto *list : {&study.data.fit, &study.data.held_out})
      for (const MeasuredPoint &m : *list)
        n_points += m.point.experiment == experiment.name() ? 1. : 0.;
    const bool is_compared = n_points > 0. || (study.data.fit.empty() && !experiment.is_held_out());
    // First runs; the rest of the budget goes where it is expected to tell most.
    constexpr double levels = 4., models = tuned::held_out::most_tested;
    const double n = experiment.is_held_out()
                         ? options.validate_runs * (2. + n_nuisances + 1.5 * models)
                     : !is_compared ? 0.
                                    : options.null_runs + 2. * options.nuisance_runs * n_nuisances +
                                          levels * tuned::runs::replicates * n_effects;
    of_base += is_compared && !experiment.is_held_out() ? options.null_runs : 0;
    const RunEstimate &estimate = experiment.estimate();
    const double hours = n * estimate.core_seconds() / 3600.;
    log.line("  experiment " + experiment.name() + " (" + experiment.process_name() +
             (experiment.is_held_out() ? ", held out" : "") +
             "): " + format_count(n_points, "measured cell", "measured cells") + "; first about " +
             format_count(n, "run", "runs") + " of " +
             format_count(estimate.particles, "particle", "particles") + " and " +
             format_count(estimate.steps, "step", "steps") + ", " +
             format_roughly(estimate.core_seconds()) + " core-seconds each");
    runs += n;
    core_hours += hours;
  }
  // What is left of the budget is spent as the first runs were.
  if (options.budget > 0) {
    core_hours *= static_cast<double>(options.budget) / std::max(1., runs);
    runs = static_cast<double>(options.budget);
  }
  log.line("  factors:    " + format_count(n_effects, "effect", "effects") + " and " +
           format_count(n_nuisances, "nuisance", "nuisances") + ": " + names);
  if (!study.left_out.empty())
    log.line("  left out, as no experiment can have them: " + boost::join(study.left_out, ", "));
  log.line("  runs:       about " + format_whole(runs) +
           (options.budget > 0 ? " at most" : " at first, and no limit"));
  log.line("  core-hours: about " + format_roughly(core_hours));
  const bool is_short = options.budget > 0 && options.budget < of_base;
  if (is_short)
    log.warning("The budget has no room for the " + std::to_string(of_base) +
                " first runs of the base model, unless the table of runs has some. Increase "
                "'budget of runs'.");
  const std::size_t n = n_warnings + (is_short ? 1 : 0);
  log.line(n == 0 ? "The study is in order."
                  : "The study can be made. " + count_of_warnings(n) + ": see above.");
}

/// Runs the base models of a study a few times, and checks that they give all data points of the
/// measured data. Those that only some of these runs give are left out.
/// @return a note on each that is left out
std::vector<std::string> check_base_models(StudyInput &study, DemSimulator &simulator)
{
  const StudyParameters &p = study.parameters;
  // As many as a study has at least, with seeds that it uses as well.
  constexpr unsigned int fewest = 8;
  simulator.find_data_points(100000 * p.options.seed + 1, {}, fewest);
  std::vector<std::string> notes;
  std::vector<DataPoint> required;
  for (auto *list : {&study.data.fit, &study.data.held_out}) {
    std::vector<MeasuredPoint> kept;
    for (const MeasuredPoint &row : *list)
      if (simulator.rare_points().count(row.point) == 0) {
        kept.push_back(row);
        required.push_back(row.point);
      } else
        notes.push_back(
            "Left out, as not every run of the base model gives it: " + row.point.experiment +
            ", " + row.point.observable + ", index " + std::to_string(row.point.index) + ".");
    *list = kept;
  }
  std::map<std::string, std::vector<DataPoint>> points;
  for (const Experiment &experiment : study.experiments)
    points[experiment.name()] = simulator.data_points(experiment.name());
  Problems problems;
  check_data_points(study.data, points, p.measured_data, problems);
  if (study.data.fit.empty())
    problems.add(p.measured_data + ":",
                 "has nothing to fit that every run of the base model gives.",
                 "Measure something else, or make the case larger.");
  refuse_if_any(problems);
  simulator.require(required);
  return notes;
}

/// Refuses a study whose folders cannot be written to, before it spends hours on runs.
void refuse_folders(const StudyParameters &p, MPI_Comm comm)
{
  on_first_rank(comm, [&] {
    Problems problems;
    for (const auto &[entry, folder] :
         {std::pair<std::string, std::string>("output path", p.output_path),
          std::pair<std::string, std::string>(
              "table of runs",
              (std::filesystem::path(".") / p.table_file()).parent_path().string())})
    {
      const std::string obstacle = obstacle_to_folder(folder);
      if (!obstacle.empty())
        problems.add("subsection 'discovery' / entry '" + entry + "':",
                     "the folder " + shortened(folder) + " cannot be written to: " + obstacle + ".",
                     "Choose another folder, or mend the permissions.");
    }
    refuse_if_any(problems);
  });
}

/// Experiments that can be simulated but were not measured.
std::vector<std::string> further_experiments(const StudyInput &study)
{
  const std::vector<std::string> measured = experiments_of(study.data.fit);
  std::vector<std::string> names;
  for (const Experiment &experiment : study.experiments)
    if (!experiment.is_held_out() &&
        std::find(measured.begin(), measured.end(), experiment.name()) == measured.end())
      names.push_back(experiment.name());
  return names;
}

/// @param tells_verdict whether the exit code is that of the verdict. MPI's launchers take every
/// code but 0 for a failure.
int make_study(StudyInput &study, const bool tells_verdict, MPI_Comm comm, Log &log)
{
  const StudyParameters &p = study.parameters;
  StudyFolder folder(p.output_path, comm);
  DemSimulator simulator(study.experiments, study.factors, p.table_file(), p.ranks_per_run, comm,
                         log);
  const auto began = folder.open(study.identity(), simulator.last_row());
  if (began) {
    log.line("Going on with the study in " + p.output_path);
    simulator.hide_rows_after(*began);
  }
  folder.write("used.prm", p.as_input_file());
  stop_request::listen();
  const std::vector<std::string> left_out = check_base_models(study, simulator);
  for (const std::string &note : left_out)
    log.line(note);
  StudyOptions options = p.options;
  options.further_experiments = further_experiments(study);
  Discovery discovery = discover(options, study.data, study.plain_factors(), simulator, log);
  for (const std::string &note : left_out)
    discovery.content["notes"].push_back(note);
  // Nuisances stay at their null values: they are of the apparatus, not of the model.
  write_models(study, discovery.model_after, folder);
  write_answer(study, discovery, simulator, folder);
  if (p.write_page)
    write_page(p.output_path, comm, log);
  for (const auto &[name, amplitude] : discovery.model_after)
    log.line("  " + name + ": " + format(amplitude));
  log.line("The answer is in " + folder.file("discovery.json"));
  return tells_verdict ? exit_code(discovery.verdict) : exit_success;
}

/// Tells which measurements would say most about which effect is missing.
void make_plan(const StudyInput &study, const std::vector<std::string> &experiments,
               DemSimulator &simulator, Log &log)
{
  std::map<std::string, double> cost;
  for (const Experiment &experiment : study.experiments)
    cost[experiment.name()] = experiment.estimate().core_seconds();
  const auto rows =
      plan(study.parameters.options, experiments, study.plain_factors(), simulator, log);
  if (!rows.empty())
    log.line("What a measurement with four repeats is expected to tell about which effect is "
             "missing, of " +
             format_roughly(rows[0].at("of").get<double>()) + " bits:");
  log.line("   bits  core-seconds of a run  experiment, observable");
  for (const auto &row : rows) {
    const std::string experiment = row.at("experiment").get<std::string>();
    char numbers[40];
    std::snprintf(numbers, sizeof numbers, "%7.2f %22.1f  ", row.at("information").get<double>(),
                  cost[experiment]);
    log.line(numbers + experiment + ", " + row.at("observable").get<std::string>());
  }
}

/// What can be done before anything is measured.
void prepare(const StudyInput &study, const ExtraArguments &arguments, MPI_Comm comm, Log &log)
{
  const StudyParameters &p = study.parameters;
  std::vector<std::string> experiments;
  for (const Experiment &experiment : study.experiments)
    experiments.push_back(experiment.name());
  // Each opens the table anew, so that a plan knows what has just been filled in.
  const auto simulate = [&](const std::function<void(DemSimulator &)> &task) {
    DemSimulator simulator(study.experiments, study.factors, p.table_file(), p.ranks_per_run, comm,
                           log);
    simulator.find_data_points(100000 * p.options.seed + 1);
    task(simulator);
  };
  if (arguments.fill_table)
    simulate([&](DemSimulator &simulator) {
      fill_table(p.options, experiments, study.plain_factors(), simulator, log);
    });
  if (arguments.plan)
    simulate([&](DemSimulator &simulator) { make_plan(study, experiments, simulator, log); });
}

/// Prints what can be told without reading a whole study.
/// @return whether it was asked for
bool tell(const CommandLine &line, const ExtraArguments &arguments, const std::string &file,
          MPI_Comm comm, Log &log)
{
  Problems problems;
  if (line.describe_parameters)
    log.line(StudyParameters::description());
  else if (arguments.list_observables)
    list_observables(log);
  else if (arguments.list_effects && file.empty()) {
    const std::vector<Effect> effects = read_effects({"standard"}, comm, problems);
    refuse_if_any(problems);
    list_effects(effects, log);
  } else if (line.print_parameters) {
    const bool with_synthetic_data = !arguments.truth_file.empty() || file.empty();
    const std::string text = file.empty() ? "" : read_file(file, comm);
    const StudyParameters parameters =
        StudyParameters::read(text, file, line.overrides, with_synthetic_data, problems,
                              [comm](const std::string &path) { return read_file(path, comm); });
    if (!file.empty())
      refuse_if_any(problems);
    log.line(parameters.as_input_file());
  } else
    return false;
  return true;
}

int run(const CommandLine &line, const ExtraArguments &arguments, MPI_Comm comm)
{
  const bool makes_data = !arguments.truth_file.empty();
  const std::string file = makes_data ? arguments.truth_file : line.file;
  const bool only_lists = arguments.list_observables || arguments.list_effects ||
                          line.print_parameters || line.describe_parameters;
  if (const auto code = answer(line, program, !only_lists && !makes_data, comm))
    return *code;
  const bool needs_no_data = arguments.plan || arguments.fill_table;
  Log log(comm, line.quiet);
  StudyInput study;
  Problems problems;
  try {
    if (tell(line, arguments, file, comm, log))
      return exit_success;
    study = read_study(file, line.overrides, makes_data, comm, problems);
    refuse_if_any(problems);
    if (arguments.list_effects) {
      list_effects(study.factors, log);
      return exit_success;
    }
    if (!makes_data && !needs_no_data)
      read_data(study, comm, problems);
    refuse_if_any(problems);
    if (!makes_data)
      refuse_folders(study.parameters, comm);
    const std::size_t n_warnings = print_doubts(study, problems, log);
    if (line.check) {
      print_check(study, n_warnings, log);
      return exit_success;
    }
  } catch (const UserError &error) {
    throw RefusedInput(error);
  }
  const bool is_study = !needs_no_data && !makes_data;
  try {
    if (is_study)
      return make_study(study, arguments.verdict_exit_code, comm, log);
    stop_request::listen();
    if (needs_no_data)
      prepare(study, arguments, comm, log);
    else
      make_synthetic_data(study.parameters, study.factors, comm, log);
    return exit_success;
  } catch (const Interrupted &) {
    log.line(std::string("Stopped as asked. ") +
             (is_study ? "Start the study again" : "Give the same command again") + " to go on.");
    return exit_stopped;
  }
}

} // namespace

int run_discovery(int argc, char **argv, MPI_Comm comm)
{
  return guarded(comm, [&] {
    ExtraArguments arguments;
    const CommandLine line = parse_command_line(
        argc, argv, program,
        {{"make-twin",
          "instead of a study, make measured data of the hidden truth in this file, which is a "
          "study with a subsection 'twin'",
          nullptr, &arguments.truth_file},
         {"plan",
          "say which experiments and observables are expected to tell most about which effect is "
          "missing; runs the base model and all effects, and needs no measured data",
          &arguments.plan},
         {"fill-table",
          "before anything is measured, fill the table with as many runs as the budget says: of "
          "the "
          "base model, of all effects, then where least is known. Studies with this table need few "
          "more. With --plan: before that",
          &arguments.fill_table},
         {"verdict-exit-code",
          "end with the verdict's code: 0 none, 10 named, 11 tie, 12 off catalogue, 13 "
          "underpowered",
          &arguments.verdict_exit_code},
         {"list-observables", "list what processes measure, and exit", &arguments.list_observables},
         {"list-effects", "list the effects of the catalogue, or of the study, and exit",
          &arguments.list_effects}});
    return run(line, arguments, comm);
  });
}

} // namespace eunoe::discovery
