#include <eunoe/core/files.h>
#include <eunoe/core/version.h>
#include <eunoe/discovery/measured_csv.h>
#include <eunoe/discovery/study_input.h>

#include <algorithm>
#include <cstdio>
#include <set>

namespace eunoe::discovery {

std::map<std::string, std::string> StudyInput::identity() const
{
  std::map<std::string, std::string> parts;
  parts["engine"] = engine_digest();
  parts["measured data"] = data_text;
  // Paths and the use of ranks do not change results; with a larger budget a study makes the same
  // runs for the fit as before, and then more.
  static const std::set<std::string> places = {"output path",   "table of runs", "ranks per run",
                                               "measured data", "write page",    "effect folders",
                                               "case file",     "budget of runs"};
  for (const auto &[place, value] : values_in(parameters.as_input_file()))
    if (places.count(place.second) == 0)
      parts["study file"] += describe(place.first, place.second) + value + "\n";
  Problems none;
  for (const Experiment &experiment : experiments) {
    parts["case of " + experiment.name()] =
        experiment.make(experiment.overrides({}, {}), none).as_input_file();
    if (!experiment.named_digests().empty())
      parts["files of " + experiment.name()] = experiment.named_digests();
  }
  for (const Effect &f : factors)
    if (f.kind == Factor::Kind::effect) {
      std::string &text = parts["effect " + f.name];
      for (const double number :
           {f.null_value, f.scale, f.lower, f.upper, static_cast<double>(f.sign)}) {
        char exactly[32];
        std::snprintf(exactly, sizeof exactly, "%.17g ", number);
        text += exactly;
      }
      text += f.process + "\n";
      for (const InputEntry &entry : f.entries)
        text += describe(entry.path, entry.name) + entry.value + "\n";
    }
  return parts;
}

StudyInput read_study(const std::string &file, const std::vector<std::string> &overrides,
                      const bool with_synthetic_data, MPI_Comm comm, Problems &problems)
{
  StudyInput study;
  const FileLoader load = [comm](const std::string &path) { return read_file(path, comm); };
  study.parameters = StudyParameters::read(read_file(file, comm), file, overrides,
                                           with_synthetic_data, problems, load);
  const StudyParameters &p = study.parameters;
  if (!problems.empty())
    return study;
  for (const ExperimentParameters &e : p.experiments)
    study.experiments.emplace_back(e, comm, problems);

  const std::vector<std::string> standard = {"standard"};
  const std::vector<std::string> &folders = p.effect_folders.empty() ? standard : p.effect_folders;
  for (Effect &effect : select(read_effects(folders, comm, problems), p.effects, p.excluded_effects,
                               file + ": subsection 'discovery'", problems))
    if (std::any_of(study.experiments.begin(), study.experiments.end(),
                    [&](const Experiment &e) { return effect.concerns(e.process_name()); }))
      study.factors.push_back(std::move(effect));
    else
      study.left_out.push_back(effect.name);
  for (const NuisanceParameters &nuisance : p.nuisances) {
    if (std::any_of(study.factors.begin(), study.factors.end(),
                    [&](const Effect &e) { return e.name == nuisance.name; }))
      problems.add(file + ": nuisance '" + nuisance.name + "'", "has the name of an effect.",
                   "Rename it, or exclude the effect.");
    study.factors.push_back(make_nuisance(nuisance, problems));
  }
  if (problems.empty())
    check_patches(study, problems);
  return study;
}

void read_data(StudyInput &study, MPI_Comm comm, Problems &problems)
{
  const std::string file = study.parameters.measured_data;
  study.data_text = read_file(file, comm);
  study.data = read_measured(study.data_text, file, study.experiments, problems);
}

void check_patches(const StudyInput &study, Problems &problems)
{
  for (const Effect &f : study.factors)
    for (const Experiment &experiment : study.experiments) {
      // Of an effect of both signs the scale may fit on one side only.
      const bool is_above = f.sign != Factor::Sign::below && f.null_value + f.scale <= f.upper;
      const double amplitude = f.null_value + (is_above ? f.scale : -f.scale);
      Problems found;
      try {
        experiment.make(experiment.overrides(study.factors, {{f.name, amplitude}}), found);
      } catch (const UserError &error) {
        problems.add("Experiment '" + experiment.name() + "':", error.what(), "");
      }
      for (const Problem &problem : found.all())
        problems.add((f.file.empty() ? "Nuisance '" + f.name + "'" : f.file) + ", in experiment '" +
                         experiment.name() + "':",
                     problem.text(), "");
    }
}

} // namespace eunoe::discovery
