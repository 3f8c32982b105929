#ifndef eunoe_tests_discovery_suite_h
#define eunoe_tests_discovery_suite_h

// Blind suites on simulators that cost nothing: hidden truths, their data, a study of each, and its
// answer, one line of JSON per study. contrib/tools score makes the tables.

#include "known_simulator.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <mpi.h>
#include <set>

namespace test {

/// Studies of one sort.
struct StudyKind
{
  std::string kind; ///< none, single, two, deleted, confounded
  double strength = 0.;
  unsigned int n_truths = 0;
};

inline const std::vector<StudyKind> &standard_kinds()
{
  static const std::vector<StudyKind> kinds = {
      {"none"},       {"single", 2., 1}, {"single", 4., 1},  {"single", 8., 1},
      {"two", 6., 2}, {"two", 8., 2},    {"deleted", 8., 1}, {"confounded", 8., 1}};
  return kinds;
}

/// One hidden truth.
struct SuiteCase
{
  std::string kind;
  std::uint32_t seed = 1;
  std::map<std::string, double> strengths; ///< of the effects; negative: below the null value
  Amplitudes truth;                        ///< with the nuisances
  std::vector<std::string> excluded;       ///< deleted from the catalogue
};

/// What the command line of a suite asks for.
struct SuiteOptions
{
  std::uint32_t first_seed = 1, n_seeds = 10;
  StudyOptions study;
  std::string only; ///< beginning of the kinds, "single 4"
  std::vector<std::string> others;

  SuiteOptions(int argc, char **argv)
  {
    if (argc > 1)
      first_seed = static_cast<std::uint32_t>(std::atoi(argv[1]));
    if (argc > 2)
      n_seeds = static_cast<std::uint32_t>(std::atoi(argv[2]));
    for (int k = 3; k < argc; ++k) {
      const std::string option = argv[k];
      if (option.rfind("budget=", 0) == 0)
        study.budget = std::stoul(option.substr(7));
      else if (option.rfind("only=", 0) == 0)
        only = option.substr(5);
      else
        others.push_back(option);
    }
  }

  bool wants(const StudyKind &kind) const
  {
    char text[40];
    std::snprintf(text, sizeof text, "%s %g", kind.kind.c_str(), kind.strength);
    return std::string(text).rfind(only, 0) == 0;
  }
};

/// Draws which effects are missing and how much of each; their amplitudes have the kind's strength.
/// Nuisances are drawn from their distributions.
inline SuiteCase draw_case(const KnownSimulator &simulator, const StudyKind &kind,
                           const std::vector<std::string> &fit, std::uint32_t seed,
                           RandomStream &random)
{
  SuiteCase one;
  one.kind = kind.kind;
  one.seed = seed;
  std::vector<std::string> effects;
  for (const Factor &f : simulator.factors())
    if (f.kind == Factor::Kind::effect)
      effects.push_back(f.name);
  for (unsigned int tries = 0; one.strengths.size() < kind.n_truths && tries < 100; ++tries) {
    const Factor &f = simulator.factor(effects[random.index(effects.size())]);
    const bool below =
        f.sign == Factor::Sign::below || (f.sign == Factor::Sign::both && random.uniform() < 0.5);
    const double amplitude = simulator.amplitude_of(f.name, kind.strength, fit, below ? -1. : 1.);
    if (one.strengths.count(f.name) > 0 || amplitude < f.lower || amplitude > f.upper)
      continue; // too weak in its range
    one.strengths[f.name] = below ? -kind.strength : kind.strength;
    one.truth[f.name] = amplitude;
  }
  if (kind.kind == "deleted" && !one.strengths.empty())
    one.excluded = {one.strengths.begin()->first};
  for (const Factor &f : simulator.factors())
    if (f.kind == Factor::Kind::nuisance)
      one.truth[f.name] = f.null_value + f.prior_deviation * random.normal();
  return one;
}

/// A study's answer and the truth: a line that contrib/eunoe/discovery/score.py reads.
inline void print_outcome(const SuiteCase &one, const Discovery &discovery)
{
  const auto &c = discovery.content;
  nlohmann::ordered_json amplitudes = nlohmann::ordered_json::object();
  for (const auto &[name, strength] : one.strengths)
    amplitudes[name] = one.truth.at(name);
  char name[80];
  std::snprintf(name, sizeof name, "%s_%g_%u", one.kind.c_str(),
                one.strengths.empty() ? 0. : std::abs(one.strengths.begin()->second), one.seed);
  nlohmann::ordered_json held_out = nlohmann::ordered_json::object();
  for (const auto &[key, value] : c["gaps"]["held-out"].items())
    if (key != "envelopes")
      held_out[key] = value;
  nlohmann::ordered_json candidates = nlohmann::ordered_json::array();
  for (const auto &row : c["candidates"])
    candidates.push_back({{"effect", row["effect"]}, {"confidence", row["confidence"]}});
  const nlohmann::ordered_json line = {
      {"case",
       {{"name", name},
        {"kind", one.kind},
        {"seed", one.seed},
        {"study_seed", one.seed},
        {"strengths", one.strengths},
        {"excluded", one.excluded},
        {"amplitudes", amplitudes}}},
      {"answer",
       {{"verdict", c["verdict"]},
        {"detected", c["detected"]},
        {"p of nothing missing", c["p of nothing missing"]},
        {"confidence off catalogue", c["confidence off catalogue"]},
        {"candidates", candidates},
        {"amplitudes", c["amplitudes"]},
        {"p of the fit", c["p of the fit"]},
        {"tie", c["tie"]},
        {"models", c["models"]},
        {"calibration", c["calibration"]},
        {"learning curve", c["learning curve"]},
        {"gaps", {{"fit", c["gaps"]["fit"]}, {"held-out", held_out}}},
        {"runs", c["runs"]}}}};
  std::printf("%s\n", line.dump().c_str());
}

/// The study of a case; its seed is that of the case, so that no two studies share a run.
inline Discovery study_of(const SuiteCase &one, KnownSimulator &simulator, const MeasuredData &data,
                          StudyOptions options)
{
  options.seed = one.seed;
  Log log(MPI_COMM_SELF, true);
  const std::vector<Factor> factors =
      one.excluded.empty() ? simulator.factors() : simulator.factors_without(one.excluded.front());
  return discover(options, data, factors, simulator, log);
}

/// What main() of a suite does. Each line of its output is there as soon as it is printed.
inline int run_suite(int argc, char **argv, void (*run)(const SuiteOptions &))
{
  MPI_Init(&argc, &argv);
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
  int code = 0;
  try {
    run(SuiteOptions(argc, argv));
  } catch (const std::exception &error) {
    std::fprintf(stderr, "%s\n", error.what());
    code = 1;
  }
  MPI_Finalize();
  return code;
}

} // namespace test

#endif
