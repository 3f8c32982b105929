#include <eunoe/core/declare.h>
#include <eunoe/core/parameter_input.h>
#include <eunoe/core/quoted_text.h>
#include <eunoe/discovery/study_parameters.h>

#include <deal.II/base/parameter_handler.h>

#include <boost/algorithm/string/join.hpp>

#include <algorithm>
#include <filesystem>
#include <set>

namespace eunoe::discovery {

namespace {

const std::string study_section = "discovery";
using Path = std::vector<std::string>;

const std::vector<RepeatedSections> &repeated_sections()
{
  static const std::vector<RepeatedSections> list = {
      {{study_section}, "number of experiments", "experiment", 20, 0},
      {{study_section}, "number of nuisances", "nuisance", 20, 0}};
  return list;
}

void declare_experiment(dealii::ParameterHandler &prm, ExperimentParameters &experiment)
{
  declare::entry(prm, "name", experiment.name,
                 "Name by which the measured data call the experiment.");
  declare::entry(prm, "case file", experiment.case_file,
                 "Base model: an input file of eunoe-particles with a process.");
  declare::list(prm, "overrides", experiment.overrides, ';',
                "Entries that differ from the case file: 'subsection/entry = value; ...'.");
  declare::entry(prm, "held out", experiment.held_out,
                 "Whether the experiment only serves to test the answer: its data are not "
                 "looked at before.");
}

void declare_nuisance(dealii::ParameterHandler &prm, NuisanceParameters &nuisance)
{
  declare::entry(prm, "name", nuisance.name, "Name of the uncertain number.");
  declare::list(prm, "entries", nuisance.entries, ';',
                "Entries of the case that get the value: 'subsection/entry; ...'.");
  declare::entry(prm, "value", nuisance.value,
                 "Their value, with 'amplitude', which is 0 on average, and 'base', the value "
                 "in the case.");
  declare::not_negative(prm, "standard deviation", nuisance.standard_deviation,
                        "Standard deviation of the amplitude.");
}

void declare_options(dealii::ParameterHandler &prm, StudyOptions &options)
{
  declare::between(prm, "level", options.level, 1e-4, 0.5,
                   "Accepted probability that something is said to be missing while nothing is.");
  declare::count(
      prm, "budget of runs", options.budget,
      "Most simulations that a study asks for, besides those that first show that each experiment "
      "runs; 0: no limit. It stops before when more of them no longer change the answer.",
      0);
  declare::count(prm, "null runs", options.null_runs,
                 "First runs of the base model of every experiment.", 8);
  declare::count(prm, "nuisance runs", options.nuisance_runs,
                 "First runs on either side of each nuisance.", 2);
  declare::count(prm, "validate runs", options.validate_runs,
                 "Runs of each held-out experiment for each model that is tested.", 3);
  declare::count(prm, "seed", options.seed, "Seed of the study, from which those of its runs come.",
                 0);
  declare::not_negative(prm, "model tolerance", options.model_tolerance,
                        "Relative deviation that is forgiven to every value of the base model, for "
                        "what its step or depth leaves out.");
}

void declare_synthetic_data(dealii::ParameterHandler &prm, SyntheticDataParameters &synthetic)
{
  declare::enter(prm, "twin");
  declare::list(prm, "effects", synthetic.effects, ',',
                "The truth: 'name: amplitude, ...'; empty: nothing is missing.");
  declare::list(prm, "overrides", synthetic.overrides, ';',
                "Entries in which the truth's simulations differ from the model's without being "
                "effects, such as the depth: 'subsection/entry = value; ...'.");
  declare::list(
      prm, "observables", synthetic.observables, ',',
      "Observables that are measured: 'all', or names, with ':' and an index for one of its data "
      "points.");
  declare::between(prm, "time step factor", synthetic.time_step_factor, 0.05, 2.,
                   "Time step of the truth, in terms of the model's.");
  declare::entry(prm, "jitter nuisances", synthetic.jitter_nuisances,
                 "Whether the truth's nuisances are drawn from their distributions.");
  declare::not_negative(prm, "noise", synthetic.noise,
                        "Standard deviation of the measurement, relative to the observable's root "
                        "mean square over its cells.");
  declare::count(prm, "repeats", synthetic.repeats, "Number of repeated measurements.", 2);
  declare::count(prm, "seed", synthetic.seed,
                 "Seed of the truth: powder, packing, noise, nuisances.", 0);
  declare::entry(prm, "sealed file", synthetic.sealed_file, "File that keeps the truth.");
  declare::leave(prm);
}

bool is_plain_word(const std::string &name)
{
  return !name.empty() && std::all_of(name.begin(), name.end(), [](const unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-';
  });
}

void check_name(const ParameterCheck &check, const Path &path, const std::string &name,
                std::set<std::string> &names)
{
  check.require(is_plain_word(name), path, "name", "is '" + shortened(name) + "'.",
                "Give a word of letters, digits, '_' and '-'.");
  check.require(names.insert(name).second, path, "name",
                "is '" + shortened(name) + "', like that of another one.",
                "Give each its own name.");
}

/// A file that is named in an input file, or an empty name.
std::string beside(const std::string &name, const std::string &input_file)
{
  if (name.empty())
    return name;
  return (std::filesystem::path(input_file).parent_path() / name).lexically_normal().string();
}

/// Makes names of files relative to the folder in which the program was started, as their entries
/// give them relative to the input file in which they are written.
void resolve_files(std::vector<InputEntry> &entries, const std::string &file,
                   const bool with_synthetic_data)
{
  // Defaults first, so that what is written overrides them.
  const std::string unwritten = file + ":0";
  if (with_synthetic_data)
    entries.insert(
        entries.begin(),
        InputEntry{{"twin"}, "sealed file", SyntheticDataParameters().sealed_file, unwritten});
  entries.insert(
      entries.begin(),
      InputEntry{{study_section}, "measured data", StudyParameters().measured_data, unwritten});
  for (InputEntry &entry : entries) {
    if (entry.where.rfind("--set", 0) == 0)
      continue;
    const std::string written_in = entry.where.substr(0, entry.where.rfind(':'));
    if (entry.name == "measured data" || entry.name == "case file" || entry.name == "sealed file")
      entry.value = beside(entry.value, written_in);
    if (entry.name == "effect folders") {
      std::vector<std::string> folders = dealii::Utilities::split_string_list(entry.value, ',');
      for (std::string &folder : folders)
        folder = folder == "standard" ? folder : beside(folder, written_in);
      entry.value = boost::join(folders, ", ");
    }
  }
}

} // namespace

void StudyParameters::declare(dealii::ParameterHandler &prm, const bool with_synthetic_data)
{
  declare::enter(prm, study_section);
  declare::entry(prm, "measured data", measured_data, "Table of what was measured.");
  declare::entry(prm, "output path", output_path,
                 "Folder of all results; created if missing, and gone on with if it holds the "
                 "same study.");
  declare::entry(prm, "table of runs", table_of_runs,
                 "SQLite file in which all simulations are kept; several studies may share it. "
                 "Empty: the output path with '_runs.sqlite' behind it, so that deleting the "
                 "results loses no simulation.");
  declare::list(prm, "effects", effects, ',',
                "Effects that may be missing: 'all' of the catalogue, or names.");
  declare::list(prm, "excluded effects", excluded_effects, ',', "Effects that are left out.");
  declare::list(prm, "effect folders", effect_folders, ',',
                "Folders of effects, one file each; empty: the catalogue that comes with the "
                "program, which may also be named 'standard' beside others.");
  declare_options(prm, options);
  declare::count(prm, "ranks per run", ranks_per_run, "MPI ranks that share a simulation.", 1);
  declare::entry(prm, "write page", write_page,
                 "Whether discovery.html is written; needs Python with Matplotlib.");
  for (const RepeatedSections &repeated : repeated_sections()) {
    // Read before all others, as it decides what there is to be declared.
    declare::number_of(prm, repeated.entry,
                       repeated.prefix == "experiment" ? experiments.size() : nuisances.size(), 0,
                       static_cast<int>(repeated.largest),
                       "How many subsections '" + repeated.prefix + " 0', ... there are.");
  }
  for (std::size_t k = 0; k < experiments.size(); ++k) {
    declare::enter(prm, "experiment " + std::to_string(k));
    declare_experiment(prm, experiments[k]);
    declare::leave(prm);
  }
  for (std::size_t k = 0; k < nuisances.size(); ++k) {
    declare::enter(prm, "nuisance " + std::to_string(k));
    declare_nuisance(prm, nuisances[k]);
    declare::leave(prm);
  }
  declare::leave(prm);
  if (with_synthetic_data)
    declare_synthetic_data(prm, synthetic);
}

std::string StudyParameters::description()
{
  StudyParameters one_of_each;
  one_of_each.experiments.resize(1);
  one_of_each.nuisances.resize(1);
  dealii::ParameterHandler prm;
  one_of_each.declare(prm, true);
  return describe_entries(prm, repeated_sections());
}

std::string StudyParameters::table_file() const
{
  if (!table_of_runs.empty())
    return table_of_runs;
  std::filesystem::path path = std::filesystem::path(output_path).lexically_normal();
  if (!path.has_filename())
    path = path.parent_path(); // a slash at the end
  // "." and ".." have no name to put something behind.
  const std::string name = path.filename().string();
  return name.empty() || name == "." || name == ".." ? (path / "runs.sqlite").string()
                                                     : path.string() + "_runs.sqlite";
}

void StudyParameters::check(const ParameterCheck &check) const
{
  check.require(!experiments.empty(), {study_section}, "number of experiments", "is 0.",
                "Describe at least one experiment.");
  std::set<std::string> names;
  for (std::size_t k = 0; k < experiments.size(); ++k) {
    const Path path = {study_section, "experiment " + std::to_string(k)};
    check_name(check, path, experiments[k].name, names);
    check.require(!experiments[k].case_file.empty(), path, "case file", "is missing.",
                  "Name an input file of eunoe-particles.");
  }
  check.require(std::any_of(experiments.begin(), experiments.end(),
                            [](const ExperimentParameters &e) { return !e.held_out; }) ||
                    experiments.empty(),
                {study_section}, "", "has only experiments that are held out.",
                "Leave at least one to look at.");
  names.clear();
  for (std::size_t k = 0; k < nuisances.size(); ++k) {
    const Path path = {study_section, "nuisance " + std::to_string(k)};
    check_name(check, path, nuisances[k].name, names);
    check.require(!nuisances[k].entries.empty(), path, "entries", "is empty.",
                  "Name the entries of the case that are uncertain.");
    check.require(nuisances[k].value.find("amplitude") != std::string::npos, path, "value",
                  "does not depend on the amplitude.", "Use 'amplitude' in '${...}'.");
    check.require(nuisances[k].standard_deviation > 0., path, "standard deviation", "is 0.",
                  "Give a positive one, or remove the nuisance.");
  }
}

StudyParameters StudyParameters::read(const std::string &text, const std::string &file,
                                      const std::vector<std::string> &overrides,
                                      const bool with_synthetic_data, Problems &problems,
                                      const FileLoader &load)
{
  std::vector<InputEntry> entries =
      parse_input_and_overrides(text, file, overrides, problems, load);
  resolve_files(entries, file, with_synthetic_data);
  StudyParameters study;
  study.experiments.resize(repeated_sections()[0].count(entries));
  study.nuisances.resize(repeated_sections()[1].count(entries));
  dealii::ParameterHandler prm;
  study.declare(prm, with_synthetic_data);
  set_entries(prm, entries, repeated_sections(), problems);
  study.complete_input = complete_text(prm);
  if (problems.empty())
    study.check(ParameterCheck(entries, file, problems));
  return study;
}

} // namespace eunoe::discovery
