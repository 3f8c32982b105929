// The effects that come with the program: each is understood, its null value leaves no trace in the
// input of the micro experiments, and its scale does.

#include <eunoe/core/version.h>
#include <eunoe/discovery/study_input.h>

#include "../tests.h"

EUNOE_MPI_TEST()
{
  using namespace test;
  using namespace eunoe::discovery;
  const std::string sources = source_folder();
  Problems problems;
  StudyInput study;
  study.factors = read_effects({sources + "/prm/effects"}, MPI_COMM_WORLD, problems);
  for (const std::string name : {"spreading", "heap"}) {
    ExperimentParameters experiment;
    experiment.name = name;
    experiment.case_file = sources + "/prm/discovery/micro_" + name + ".prm";
    study.experiments.emplace_back(experiment, MPI_COMM_WORLD, problems);
  }
  check_patches(study, problems);
  for (const Problem &problem : problems.all())
    print(problem.text());
  check("at least 14 effects", study.factors.size() >= 14);
  std::vector<std::string> names;
  for (const Effect &effect : study.factors)
    names.push_back(effect.name);
  for (const Effect &effect : study.factors) {
    const Factor &f = effect;
    bool null_is_base = true, known = true;
    int n_changed = 0, n_concerned = 0;
    for (const Experiment &experiment : study.experiments) {
      const auto input = [&](const Amplitudes &amplitudes) {
        return experiment.make(experiment.overrides(study.factors, amplitudes), problems)
            .as_input_file();
      };
      null_is_base &= experiment.overrides(study.factors, {{f.name, f.null_value}}).empty();
      const double side = f.sign == Factor::Sign::below ? -1. : 1.;
      n_changed += input({}) != input({{f.name, f.null_value + side * f.scale}}) ? 1 : 0;
      n_concerned += effect.concerns(experiment.process_name()) ? 1 : 0;
    }
    for (const std::string &other : f.confounders)
      known &= std::find(names.begin(), names.end(), other) != names.end();
    if (!null_is_base || n_changed != n_concerned || n_concerned == 0 || !known)
      print(f.name + ": null value " + (null_is_base ? "ok" : "leaves a trace") + ", changes " +
            std::to_string(n_changed) + " of " + std::to_string(n_concerned) + " cases" +
            (known ? "" : ", names an unknown confounder"));
  }
  check("no problem", problems.empty());
}
