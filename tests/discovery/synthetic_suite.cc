// A blind suite on synthetic laboratories: many studies in which the truth is hidden, and how often
// the verdicts are right. It takes minutes to hours and is no part of ctest.
//   synthetic-suite [first seed] [seeds] [option=value ...]

#include "synthetic.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <mpi.h>
#include <set>

namespace {

using namespace test;

/// What the command line changes.
Nature common_nature;
const std::vector<std::string> fit = {"spreading", "heap"}, held_out = {"thick layers"};

struct StudyKind
{
  std::string name;
  double strength = 0.;
  unsigned int n_truths = 0;
  bool deleted = false, confounded = false;
};

/// Sums over all studies of one case.
struct StudyTally
{
  double studies = 0., detected = 0., first = 0., covered = 0., set_size = 0., sets = 0.;
  double wrong = 0., off = 0., amplitude_covered = 0., amplitudes = 0., error = 0., runs = 0.;
  double extra = 0., confidence = 0., withdrawn = 0.;
  std::map<std::string, int> verdicts;
  std::vector<double> shrinks;
};

std::vector<std::string> split(const std::string &set)
{
  std::vector<std::string> result;
  std::size_t begin = 0;
  while (begin < set.size()) {
    const std::size_t end = std::min(set.find(" + ", begin), set.size());
    result.push_back(set.substr(begin, end - begin));
    begin = end + 3;
  }
  return result;
}

void score(const Discovery &d, const Amplitudes &truth, const StudyKind &which, StudyTally &t)
{
  const auto &c = d.content;
  if (truth.empty() && std::getenv("EUNOE_SUITE_VERBOSE") != nullptr)
    std::printf("  p %.3f (distance %.3f, cell %.3f, gain %.3f)\n",
                c["stages"]["screen"]["p"].get<double>(),
                c["stages"]["detect"]["p of distance"].get<double>(),
                c["stages"]["detect"]["p of largest deviation"].get<double>(),
                c["stages"]["screen"]["p of largest gain"].get<double>());
  t.studies += 1.;
  t.runs += static_cast<double>(d.n_runs);
  t.verdicts[name_of(d.verdict)]++;
  const bool detected = d.verdict != Verdict::none && d.verdict != Verdict::underpowered;
  t.detected += detected;
  t.off += d.verdict == Verdict::off_catalogue;
  const std::string result = c["gaps"]["held-out"].value("result", std::string());
  t.withdrawn += result.find("withdrawn") != std::string::npos;
  if (!detected)
    return;
  const auto candidates = c["candidates"];
  std::set<std::string> names, named;
  for (const auto &[name, amplitude] : truth)
    names.insert(name);
  const std::string first = candidates[0]["effect"];
  t.first += !which.deleted && names.count(first) > 0;
  if (d.verdict == Verdict::named || d.verdict == Verdict::tie) {
    for (const auto &[name, amplitude] : d.model_after)
      named.insert(name);
    std::vector<std::set<std::string>> sets;
    if (d.verdict == Verdict::tie)
      for (const auto &row : c["tie"]) {
        const auto parts = split(row["effects"]);
        sets.emplace_back(parts.begin(), parts.end());
      }
    else
      sets.push_back(named);
    bool covers = false;
    for (const auto &set : sets)
      covers = covers || (!which.deleted && set == names);
    t.covered += covers;
    t.set_size += static_cast<double>(sets.size());
    t.sets += 1.;
    t.extra += named.size() > names.size();
    bool all_wrong = true;
    for (const auto &name : named)
      all_wrong = all_wrong && (which.deleted || names.count(name) == 0);
    const double confidence = candidates[0]["confidence"];
    t.wrong += d.verdict == Verdict::named && confidence > 0.9 && all_wrong;
    const auto &gap = c["gaps"]["held-out"];
    if (d.verdict == Verdict::named && gap.contains("shrink") && gap["shrink"].is_number())
      t.shrinks.push_back(gap["shrink"]);
  }
  if (!which.deleted)
    for (const auto &row : c["amplitudes"]) {
      const std::string name = row["effect"];
      if (names.count(name) == 0)
        continue;
      const double a = truth.at(name);
      t.amplitudes += 1.;
      if (std::getenv("EUNOE_SUITE_VERBOSE") != nullptr)
        std::printf("  %s: %.4g for %.4g in [%.4g, %.4g]\n", name.c_str(),
                    row["amplitude"].get<double>(), a, row["lower"].get<double>(),
                    row["upper"].get<double>());
      t.amplitude_covered += a >= row["lower"] && a <= row["upper"];
      t.error += std::abs(row["amplitude"].get<double>() / a - 1.);
    }
  t.confidence += candidates[0]["confidence"].get<double>();
}

Discovery study(const StudyKind &which, std::uint32_t seed, const StudyOptions &base_options,
                Amplitudes &truth, Log &log)
{
  RandomStream random(seed, 99);
  Nature nature = common_nature;
  nature.seed = seed;
  nature.strength_of_scale = 3. + 4. * random.uniform();
  nature.seed_correlation = 0.6 * random.uniform();
  SyntheticLaboratory laboratory(nature);
  std::vector<std::string> effects;
  for (const Factor &f : laboratory.factors())
    if (f.kind == Factor::Kind::effect)
      effects.push_back(f.name);
  std::size_t at = random.index(effects.size());
  if (which.confounded)
    laboratory.make_alike(effects[at], effects[(at + 4) % effects.size()], 0.1,
                          {"spreading", "heap"});
  std::vector<Factor> factors = laboratory.factors();
  for (unsigned int k = 0; k < which.n_truths; ++k) {
    const Factor &f = laboratory.factor(effects[at]);
    const double side = f.sign == Factor::Sign::both && random.uniform() < 0.5 ? -1. : 1.;
    truth[f.name] = laboratory.amplitude_of(f.name, which.strength, fit, side);
    at = (at + 1 + random.index(effects.size() - 1)) % effects.size();
  }
  if (which.deleted)
    factors = laboratory.factors_without(truth.begin()->first);
  Amplitudes all = truth;
  for (const Factor &f : laboratory.factors())
    if (f.kind == Factor::Kind::nuisance)
      all[f.name] = f.null_value + f.prior_deviation * random.normal();
  const unsigned int repeats = 3 + static_cast<unsigned int>(random.index(4));
  const MeasuredData data =
      laboratory.measure(fit, held_out, all, repeats, 0.4 * random.uniform(), seed);
  StudyOptions options = base_options;
  options.further_experiments = {"shear"};
  TransientStore store;
  return discover(options, data, factors, laboratory, store, log);
}

void print(const StudyKind &which, StudyTally &t)
{
  std::sort(t.shrinks.begin(), t.shrinks.end());
  const double median = t.shrinks.empty() ? 0. : t.shrinks[t.shrinks.size() / 2];
  std::printf(
      "%-16s n %3.0f detected %.3f first %.3f | sets %.0f cover %.3f size %.2f extra %.2f | "
      "off %.3f wrong %.3f withdrawn %.2f | confidence %.2f amplitude %.3f error %.2f | "
      "shrink %.2f runs %.0f |",
      which.name.c_str(), t.studies, t.detected / t.studies, t.first / std::max(1., t.detected),
      t.sets, t.covered / std::max(1., t.sets), t.set_size / std::max(1., t.sets),
      t.extra / std::max(1., t.sets), t.off / t.studies, t.wrong / t.studies,
      t.withdrawn / t.studies, t.confidence / std::max(1., t.detected),
      t.amplitude_covered / std::max(1., t.amplitudes), t.error / std::max(1., t.amplitudes),
      median, t.runs / t.studies);
  for (const auto &[name, count] : t.verdicts)
    std::printf(" %s %d", name.c_str(), count);
  std::printf("\n");
  std::fflush(stdout);
}

} // namespace

int main(int argc, char **argv)
{
  MPI_Init(&argc, &argv);
  const auto first = static_cast<std::uint32_t>(argc > 1 ? std::atoi(argv[1]) : 1);
  const auto number = static_cast<std::uint32_t>(argc > 2 ? std::atoi(argv[2]) : 10);
  StudyOptions options;
  std::string only;
  for (int k = 3; k < argc; ++k) {
    const std::string option = argv[k];
    if (option == "no-common-random-numbers")
      options.common_random_numbers = false;
    else if (option == "no-confirmation")
      options.confirm = false;
    else if (option == "chi-square")
      options.bootstrap = false;
    else if (option == "no-nuisances")
      common_nature.n_nuisances = 0;
    else if (option == "no-bend")
      common_nature.bend = 0.;
    else if (option == "even-chaos")
      common_nature.changed_chaos = common_nature.skewness = 0.;
    else if (option == "no-swing")
      common_nature.swing = 0.;
    else
      only = option;
  }
  {
    Log log(MPI_COMM_SELF, true);
    std::vector<StudyKind> cases = {{"none"}};
    for (const double strength : {2., 4., 8.})
      cases.push_back({"one " + std::to_string(int(strength)), strength, 1});
    cases.push_back({"two 6", 6., 2});
    cases.push_back({"deleted 8", 8., 1, true});
    cases.push_back({"alike 8", 8., 1, false, true});
    for (const StudyKind &which : cases) {
      if (!only.empty() && which.name.find(only) != 0)
        continue;
      StudyTally tally;
      for (std::uint32_t seed = first; seed < first + number; ++seed) {
        Amplitudes truth;
        const Discovery d = study(which, seed, options, truth, log);
        score(d, truth, which, tally);
      }
      print(which, tally);
    }
  }
  MPI_Finalize();
  return 0;
}
