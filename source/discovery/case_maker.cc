#include <eunoe/core/files.h>
#include <eunoe/core/named_files.h>
#include <eunoe/core/problems.h>
#include <eunoe/core/sha256.h>
#include <eunoe/core/version.h>
#include <eunoe/discovery/case_maker.h>
#include <eunoe/discovery/work_queue.h>

#include <algorithm>

namespace eunoe::discovery {

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

bool CaseMaker::is_of_study(const RunRequest &request) const
{
  return std::any_of(experiments.begin(), experiments.end(),
                     [&](const Experiment &e) { return e.name() == request.experiment; }) &&
         std::all_of(request.amplitudes.begin(), request.amplitudes.end(), [&](const auto &a) {
           return std::any_of(factors.begin(), factors.end(),
                              [&](const Effect &e) { return e.factor.name == a.first; });
         });
}

const Experiment &CaseMaker::find(const std::string &name) const
{
  return *std::find_if(experiments.begin(), experiments.end(),
                       [&](const Experiment &e) { return e.name() == name; });
}

StudyCase CaseMaker::make(const RunRequest &request) const
{
  StudyCase one;
  one.experiment = &find(request.experiment);
  one.request = request;
  std::string input;
  EntryValues naming_files;
  try {
    one.overrides = one.experiment->run_overrides(factors, request);
    Problems problems;
    const Parameters parameters = one.experiment->make(one.overrides, problems);
    input = parameters.as_input_file();
    naming_files = parameters.file_entries();
    if (!problems.empty())
      throw UserError(problems);
  } catch (const UserError &error) {
    one.problem = error.what();
  }
  // Ranks may see different files: if one cannot make the case, none runs it.
  const std::string of_first = broadcast(one.problem, comm);
  one.problem = of_first.empty() ? concatenate(one.problem, comm) : of_first;
  if (one.problem.empty()) {
    std::string files;
    for (const auto &[place, digest] : named_files(naming_files, comm))
      files += digest;
    one.names_files = !files.empty();
    one.key = sha256(files + input);
  } else
    one.key = sha256(one.problem + text_of(request));
  return one;
}

std::string CaseMaker::key(const RunRequest &request)
{
  std::string recipe;
  try {
    const Experiment &experiment = find(request.experiment);
    // The engine reads the parameters.
    recipe =
        sha256(engine_digest() + experiment.recipe(experiment.run_overrides(factors, request)));
  } catch (const UserError &) {
    return make(request).key;
  }
  if (const auto known = keys_by_recipe.find(recipe); known != keys_by_recipe.end())
    return known->second;
  const StudyCase one = make(request);
  // Files that a case names may change without their names.
  if (one.problem.empty() && !one.names_files)
    keys_by_recipe[recipe] = found[recipe] = one.key;
  return one.key;
}

} // namespace eunoe::discovery
