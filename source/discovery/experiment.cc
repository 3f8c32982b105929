#include <eunoe/core/files.h>
#include <eunoe/core/first_rank.h>
#include <eunoe/core/named_files.h>
#include <eunoe/core/quoted_text.h>
#include <eunoe/core/sha256.h>
#include <eunoe/discovery/experiment.h>
#include <eunoe/simulation/simulation.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>

namespace eunoe::discovery {

namespace {

/// Overrides that make a run silent.
const std::vector<std::string> quiet_overrides = {"simulation control/output path = unused",
                                                  "simulation control/output control = iteration",
                                                  "simulation control/output frequency = 0",
                                                  "simulation control/log frequency = 0",
                                                  "restart/checkpoint = false",
                                                  "restart/restart = false"};

/// What tells cases apart. Entries that have their defaults do not count, nor do comments, so that
/// a program with more entries, or other words about them, knows its runs again.
std::string identity_of(const Parameters &parameters)
{
  const EntryValues &values = parameters.entries();
  std::string text;
  for (const auto &[place, written] : parameters.changed_entries()) {
    for (const std::string &section : place.first)
      text += section + "/";
    // One that was set by another of its names is not in the complete input.
    const auto value = values.find(place);
    text += place.second + " = " + (value != values.end() ? value->second : written) + "\n";
  }
  return text;
}

/// Digests of files that entries name; collective.
std::string digests_of(const EntryValues &naming_files, MPI_Comm comm)
{
  std::string digests;
  for (const auto &[place, digest] : named_files(naming_files, comm))
    digests += digest;
  return digests;
}

} // namespace

Experiment::Experiment(const ExperimentParameters &parameters, MPI_Comm comm, Problems &problems)
    : parameters(parameters)
{
  const std::string &file = parameters.case_file;
  try {
    texts[file] = read_file(file, comm);
  } catch (const UserError &error) {
    problems.add("Experiment '" + name() + "':", error.what(), "");
    return;
  }
  Problems wrong; // its doubts are among those of the run below
  const Parameters read = Parameters::read(
      texts[file], file, parameters.overrides, wrong,
      [&](const std::string &path) { return texts[path] = read_file(path, comm); });
  base = read.entries();
  process = read.process_name;
  // Every run begins from nothing.
  if (base.at({{"restart"}, "restart"}) == "true")
    wrong.add(file + ": subsection 'restart' / entry 'restart'",
              "is true, and a study simulates a case from its beginning, without checkpoints.",
              "Make a case of it that needs none, and set it to false.");
  for (const Problem &problem : wrong.all())
    problems.add(problem.where, problem.what, problem.mend);
  if (!wrong.empty())
    return;
  digests = digests_of(read.file_entries(), comm);
  try {
    // Building the parts of a run finds what reading alone cannot.
    std::vector<std::string> list = parameters.overrides;
    list.insert(list.end(), quiet_overrides.begin(), quiet_overrides.end());
    Problems found;
    Parameters of_run = make(list, found);
    if (!found.empty())
      throw UserError(found);
    Log silent(comm, true);
    Simulation simulation(of_run, comm, silent);
    simulation.make_observables();
    described = simulation.described_observables();
    cost = simulation.estimate();
    const Forecast forecast = simulation.foresee(false);
    if (!forecast.problems.empty())
      throw UserError(forecast.problems);
    for (const auto *list_of_doubts : {&found.warnings(), &forecast.problems.warnings()})
      doubtful.insert(doubtful.end(), list_of_doubts->begin(), list_of_doubts->end());
  } catch (const UserError &error) {
    problems.add(file + ":", error.what(), "");
    return;
  }
  if (described.empty())
    problems.add(file + ": entry 'process'", "is '" + process + "', and nothing is measured.",
                 "Give a process that eunoe-discovery --list-observables names, or switch on an "
                 "observable that measures.");
}

std::vector<std::string> Experiment::overrides(const std::vector<Effect> &factors,
                                               const Amplitudes &amplitudes) const
{
  std::vector<std::string> list = parameters.overrides;
  EntryValues values = base;
  std::vector<const Effect *> active;
  for (const Effect &effect : factors) {
    const auto amplitude = amplitudes.find(effect.name);
    if (amplitude != amplitudes.end() && amplitude->second != effect.null_value &&
        effect.concerns(process))
      active.push_back(&effect);
  }
  std::sort(active.begin(), active.end(), [](const Effect *a, const Effect *b) {
    const auto key = [](const Effect *e) {
      return std::pair(e->kind == Factor::Kind::effect, e->name);
    };
    return key(a) < key(b);
  });
  for (const Effect *const effect : active)
    effect->apply(amplitudes.at(effect->name), values, list);
  return list;
}

std::vector<std::string> Experiment::run_overrides(const std::vector<Effect> &factors,
                                                   const RunRequest &request) const
{
  std::vector<std::string> list = overrides(factors, request.amplitudes);
  list.insert(list.end(), quiet_overrides.begin(), quiet_overrides.end());
  // Entries hold numbers of 31 bits.
  list.push_back("simulation control/seed = " + std::to_string(request.seed & 0x7fffffff));
  return list;
}

StudyCase Experiment::make_case(const std::vector<Effect> &factors, const RunRequest &request,
                                MPI_Comm comm) const
{
  StudyCase one;
  one.experiment = this;
  one.request = request;
  std::string identity;
  EntryValues naming_files;
  try {
    // Ranks may see different files.
    on_every_rank(comm, [&] {
      one.overrides = run_overrides(factors, request);
      Problems found;
      const Parameters made = make(one.overrides, found);
      identity = identity_of(made);
      naming_files = made.file_entries();
      if (!found.empty())
        throw UserError(found);
    });
  } catch (const UserError &error) {
    one.problem = error.what();
    one.key = sha256(one.problem + text_of(request));
    return one;
  }
  const std::string files = digests_of(naming_files, comm);
  one.names_files = !files.empty();
  one.key = sha256(files + identity);
  return one;
}

std::string Experiment::old_key(const std::vector<Effect> &factors, const RunRequest &request,
                                MPI_Comm comm) const
{
  std::string input;
  EntryValues naming_files;
  try {
    on_every_rank(comm, [&] {
      Problems found;
      const Parameters made = make(run_overrides(factors, request), found);
      if (!found.empty())
        throw UserError(found);
      input = made.as_input_file();
      naming_files = made.file_entries();
    });
  } catch (const UserError &) {
    return "";
  }
  return sha256(digests_of(naming_files, comm) + input);
}

std::string Experiment::recipe(const std::vector<Effect> &factors, const RunRequest &request) const
{
  std::string all;
  for (const auto &[file, text] : texts)
    all += file + "\n" + text + "\n";
  for (const std::string &line : run_overrides(factors, request))
    all += line + "\n";
  return all;
}

std::string Experiment::all_entries() const
{
  return nlohmann::json(base).dump();
}

std::string Experiment::recipe_of_entries(const std::string &engine) const
{
  return sha256("all entries\n" + engine + recipe({}, {name(), {}, 0}));
}

bool Experiment::differs_from(const std::string &entries_by_then) const
{
  const auto then = nlohmann::json::parse(entries_by_then).get<EntryValues>();
  return std::any_of(base.begin(), base.end(), [&](const auto &entry) {
    const auto found = then.find(entry.first);
    return found != then.end() && found->second != entry.second;
  });
}

Parameters Experiment::make(const std::vector<std::string> &overrides, Problems &problems) const
{
  const std::string &file = parameters.case_file;
  return Parameters::read(
      texts.at(file), file, overrides, problems, [this](const std::string &path) {
        // A factor may name a file that the base case does not.
        const auto known = texts.find(path);
        return known != texts.end() ? known->second : read_file(path, MPI_COMM_SELF);
      });
}

std::string text_of(const RunRequest &request)
{
  std::string text = request.experiment + " " + std::to_string(request.seed);
  for (const auto &[name, amplitude] : request.amplitudes) {
    char number[40];
    std::snprintf(number, sizeof number, "=%.17g", amplitude);
    text += " " + name + number;
  }
  return text;
}

Effect make_nuisance(const NuisanceParameters &parameters, Problems &problems)
{
  Effect effect;
  effect.name = parameters.name;
  effect.kind = Factor::Kind::nuisance;
  effect.scale = effect.prior_deviation = parameters.standard_deviation;
  effect.lower = -3. * parameters.standard_deviation;
  effect.upper = 3. * parameters.standard_deviation;
  effect.sign = Factor::Sign::both;
  effect.mechanism = "uncertain number of the base model";
  const std::string where = "Nuisance '" + parameters.name + "'";
  for (const std::string &entry : parameters.entries) {
    Problems found;
    effect.entries.push_back(parse_override(entry + " = " + parameters.value, found));
    effect.entries.back().where = where;
    for (const Problem &problem : found.all())
      problems.add(where + " / entry 'entries': '" + shortened(entry) + "':", problem.what,
                   "Write 'subsection/entry', and ';' between several.");
  }
  return effect;
}

} // namespace eunoe::discovery
