// The blind suite on recorded DEM simulations: many studies with hidden truths, one line of
// JSON per study.
//   recorded-suite [first seed] [seeds] [options] > answers.jsonl
//   contrib/tools score answers.jsonl
// Options: only=KIND; budget=NUMBER; simulated (studies whose data are recorded simulations,
// instead of truths at any amplitude); describe (what the table holds, and no study); ideal (how
// often an observer who knows all fingerprints detects single effects and names them and two
// effects rightly, or another one for an effect that his catalogue lacks, and no study); level (how
// often data without any effect seem to have one, for the runs of one study each, see
// observe_level); weights and tail (see observe_weights, observe_tail); table=FILE.

#include <eunoe/discovery/inference/decision.h>
#include <eunoe/discovery/inference/design.h>
#include <eunoe/discovery/inference/twins.h>

#include "ideal_observer.h"
#include "recorded_cases.h"

namespace {

using namespace test;

void describe(const RecordedTable &table)
{
  const RecordedSimulator simulator(table, 1);
  for (const auto &[experiment, points] : table.points) {
    std::printf("%s: %zu cells, %zu runs of the base model\n", experiment.c_str(), points.size(),
                table.of(experiment, "base").size());
  }
  std::printf("%zu runs, %u failed\n", table.runs.size(), table.n_failed);
  for (const Factor &factor : table.factors) {
    std::map<double, int> amplitudes;
    for (const RecordedTable::Run *run : table.of(table.fit.front(), factor.name))
      amplitudes[run->amplitude]++;
    for (const auto &[amplitude, count] : amplitudes)
      std::printf("%s %g (%d runs): strength %.1f, share of noise %.3f, held out %.1f\n",
                  factor.name.c_str(), amplitude, count,
                  simulator.strength({{factor.name, amplitude}}, table.fit),
                  simulator.share_of_noise(factor.name, amplitude, table.fit),
                  simulator.strength({{factor.name, amplitude}}, table.held_out));
  }
}

IdealObserver observer_of(const DrawnCase &drawn)
{
  return {drawn.simulator, drawn.data.fit, drawn.repeats, drawn.instrument};
}

/// How often the ideal observer names both of two effects.
void observe_pairs(const RecordedTable &table, const StudyKind &kind, const SuiteOptions &options)
{
  constexpr double credible = 0.95;
  unsigned int named = 0, first = 0, covered = 0;
  for (std::uint32_t k = 0; k < options.n_seeds; ++k) {
    const DrawnCase drawn(table, kind, options.first_seed + k);
    IdealObserver::Names truth;
    for (const auto &[name, strength] : drawn.one.strengths)
      truth.insert(name);
    const std::vector<IdealObserver::Names> models = observer_of(drawn).models(credible);
    first += models.front() == truth;
    named += models.size() == 1 && models.front() == truth;
    covered += std::count(models.begin(), models.end(), truth) > 0;
  }
  std::printf("two of strength %g: both named in %u of %u, leading in %u, among the models in %u\n",
              kind.strength, named, options.n_seeds, first, covered);
}

/// How often the ideal observer names something outright whose catalogue lacks the effect, by all
/// the data, those that are held out, too.
void observe_deleted(const RecordedTable &table, const StudyKind &kind, const SuiteOptions &options)
{
  const DecisionRule rule;
  unsigned int named = 0;
  for (std::uint32_t k = 0; k < options.n_seeds; ++k) {
    const DrawnCase drawn(table, kind, options.first_seed + k);
    std::vector<MeasuredPoint> data = drawn.data.fit;
    data.insert(data.end(), drawn.data.held_out.begin(), drawn.data.held_out.end());
    const IdealObserver observer(drawn.simulator, data, drawn.repeats, drawn.instrument,
                                 drawn.one.excluded);
    const std::vector<IdealObserver::Names> models = observer.models(rule.credible);
    if (models.size() > 1 || observer.p_of_fit(models.front()) < rule.doubtful)
      continue;
    ++named;
    std::printf("seed %u: %s named", options.first_seed + k, drawn.one.excluded.front().c_str());
    for (const std::string &name : models.front())
      std::printf(" %s", name.c_str());
    std::printf("\n");
  }
  std::printf("deleted effect of strength %g: another one named outright in %u of %u\n",
              kind.strength, named, options.n_seeds);
}

/// How often the ideal observer detects and names the right effect, on the data of the studies with
/// the same seeds. What he takes for a detection is more than all but 5 % or 2 % of such data show
/// in which nothing is missing.
void observe(const RecordedTable &table, const SuiteOptions &options)
{
  constexpr std::uint32_t n_nulls = 1000, first_null = 0x20000000u;
  constexpr double levels[] = {0.05, 0.02};
  std::vector<double> nothing;
  for (const StudyKind &kind : standard_kinds()) {
    if (kind.kind == "two" && options.wants(kind))
      observe_pairs(table, kind, options);
    if (kind.kind == "deleted" && options.wants(kind))
      observe_deleted(table, kind, options);
    if (kind.kind != "single" || !options.wants(kind))
      continue;
    if (nothing.empty())
      for (std::uint32_t k = 0; k < n_nulls; ++k)
        nothing.push_back(observer_of({table, {"none"}, first_null + k}).log_bayes_factor());
    std::sort(nothing.rbegin(), nothing.rend());
    constexpr double credible = 0.95;
    unsigned int right = 0, covered = 0;
    std::size_t size = 0;
    std::map<double, unsigned int> detected;
    for (std::uint32_t k = 0; k < options.n_seeds; ++k) {
      const DrawnCase drawn(table, kind, options.first_seed + k);
      const IdealObserver observer = observer_of(drawn);
      const std::vector<IdealObserver::Names> names = observer.single_effects(credible);
      const IdealObserver::Names truth = {drawn.one.strengths.begin()->first};
      right += names.front() == truth;
      covered += std::count(names.begin(), names.end(), truth) > 0;
      size += names.size();
      for (const double level : levels)
        detected[level] +=
            observer.log_bayes_factor() > nothing[static_cast<std::size_t>(level * n_nulls)];
    }
    std::printf("strength %g: first name right in %u of %u, sets of 95 %% cover %u, mean size %.2f",
                kind.strength, right, options.n_seeds, covered,
                static_cast<double>(size) / options.n_seeds);
    for (const double level : levels)
      std::printf(", detected at level %g in %u", level, detected[level]);
    std::printf("\n");
  }
}

/// All runs that a study makes until its budget is used.
class Runs
{
public:
  Runs(const RecordedTable &table, const StudyKind &kind, const StudyOptions &study,
       std::uint32_t seed)
      : drawn(table, kind, seed), options(with_seed(study, seed)), space(drawn.simulator.factors()),
        fit(table.fit), samples(options, space, drawn.simulator, fit),
        design(options, space, samples, fit)
  {
    design.run_base();
    design.run_effects([&] { return target(drawn.data); });
    while (true) {
      const Target now = target(drawn.data);
      const Evidence evidence(now, space);
      if (!design.refine(evidence, weigh(evidence, options, DecisionRule().quick())))
        break;
    }
  }

  Target target(const MeasuredData &data)
  {
    return Target(sort_by_experiment(data.fit, samples), samples, options.model_tolerance);
  }

  DrawnCase drawn;
  const StudyOptions options;
  const FactorSpace space;
  const std::vector<std::string> fit;
  Samples samples;
  Design design;

private:
  static StudyOptions with_seed(StudyOptions study, const std::uint32_t seed)
  {
    study.seed = seed;
    return study;
  }
};

/// Makes the runs of a study without any effect, and evaluates many other data without any effect
/// by them: p of nothing missing must be as often below a level as the level says, whatever trail
/// the study has followed.
void observe_level(const RecordedTable &table, const StudyOptions &options,
                   const std::uint32_t seed)
{
  constexpr std::uint32_t n_data = 200, first_data = 0x10000000u;
  constexpr unsigned int n_twins = 400;
  Runs study(table, {"none"}, options, seed);
  std::map<double, unsigned int> below = {{0.05, 0}, {0.01, 0}, {0.001, 0}};
  for (std::uint32_t k = 0; k < n_data; ++k) {
    const std::uint32_t other = first_data + 1000u * seed + k;
    const Amplitudes nuisances = DrawnCase(table, {"none"}, other).one.truth;
    const Target fresh = study.target(study.drawn.simulator.measure(
        table.fit, {}, nuisances, study.drawn.repeats, study.drawn.instrument, other));
    const Evidence evidence(fresh, study.space);
    const double p =
        null_distribution(evidence, n_twins, seed).p(evidence.log_bayes_factors(fresh.data())(0));
    for (auto &[level, number] : below)
      number += p <= level;
  }
  std::printf("seed %u, %lu runs:", seed, static_cast<unsigned long>(study.samples.n_asked()));
  for (const auto &[level, number] : below)
    std::printf(" p <= %g in %u of %u;", level, number, n_data);
  std::printf("\n");
}

/// Variance of data by the scatter of runs along the weights by which a study estimates an
/// amplitude of strength 4: the simulator's, and that of the study's twins, over what it assumes.
void observe_weights(const RecordedTable &table, const StudyOptions &options,
                     const std::uint32_t seed)
{
  Runs study(table, {"single", 4., 1}, options, seed);
  const auto &[name, strength] = *study.drawn.one.strengths.begin();
  std::size_t k = 0;
  while (study.space.effect(k).name != name)
    ++k;
  const Factor &effect = study.space.effect(k);
  const double u = (study.drawn.one.truth.at(name) - effect.null_value) / effect.scale;
  const Target target = study.target(study.drawn.data);
  const auto mean = [&](const double share) { return target.predict({{k, share * u}}).mean; };
  constexpr double step = 0.02;
  const Target::Prediction prediction = target.predict({{k, u}});
  Eigen::MatrixXd covariance = prediction.gradient * prediction.gradient.transpose();
  covariance.diagonal() += target.variance(prediction);
  const Eigen::VectorXd weights = covariance.llt().solve(mean(1. + step) - mean(1. - step));
  double assumed = 0., of_twins = 0., of_simulator = 0.;
  for (const Target::Part &part : target.experiments()) {
    const Eigen::VectorXd own =
        part.rotation.transpose() * weights.segment(part.first, part.emulator.size());
    const Eigen::MatrixXd &rows = part.emulator.deviations();
    const Eigen::MatrixXd true_root =
        study.drawn.simulator.covariance(part.measured.name).llt().matrixL();
    const Eigen::MatrixXd scaled =
        part.emulator.base_deviation().cwiseInverse().asDiagonal() *
        true_root(part.measured.columns, Eigen::seqN(0, true_root.cols()));
    assumed += own.squaredNorm() / part.repeats;
    of_twins += (rows * own).squaredNorm() / static_cast<double>(rows.rows()) / part.repeats;
    of_simulator +=
        (part.emulator.whiten_scaled(scaled).transpose() * own).squaredNorm() / part.repeats;
  }
  std::printf("seed %u, %s: %.3f of the simulator, %.3f of twins\n", seed, name.c_str(),
              of_simulator / assumed, of_twins / assumed);
}

/// Small probabilities by the few draws that a study makes, beside those by many.
void observe_tail(const RecordedTable &table, const StudyOptions &options, const std::uint32_t seed)
{
  constexpr unsigned int n_tails = 60, n_draws = 400;
  Runs study(table, {"none"}, options, seed);
  const Target target = study.target(study.drawn.data);
  const Evidence evidence(target, study.space);
  std::vector<double> all;
  std::vector<Tail> tails;
  for (unsigned int k = 0; k < n_tails; ++k) {
    const Eigen::ArrayXd factors = evidence.log_bayes_factors(
        Twins(target, 1000 + k).draw(evidence.nothing().prediction, n_draws));
    all.insert(all.end(), factors.begin(), factors.end());
    tails.emplace_back(factors);
  }
  std::sort(all.rbegin(), all.rend());
  std::printf("seed %u, p by %zu draws, and by %u: tenth, median, nine tenths\n", seed, all.size(),
              n_draws);
  for (const double p : {0.05, 0.02, 0.01, 0.001, 0.0002}) {
    const double value = all[static_cast<std::size_t>(p * static_cast<double>(all.size()))];
    std::vector<double> found;
    for (const Tail &tail : tails)
      found.push_back(tail.p(value));
    std::sort(found.begin(), found.end());
    std::printf("%g: %.2g, %.2g, %.2g\n", p, found[n_tails / 10], found[n_tails / 2],
                found[9 * n_tails / 10]);
  }
}

void study_simulations(const RecordedTable &table, const StudyOptions &options,
                       const std::uint32_t seed)
{
  for (const LeftOut &left_out : simulated_data(table)) {
    const RecordedStudy study = simulated_study(table, left_out, seed, options);
    print_outcome(study.one, study.discovery);
  }
}

void run(const SuiteOptions &options)
{
  using OfSeed = void (*)(const RecordedTable &, const StudyOptions &, std::uint32_t);
  const std::map<std::string, OfSeed> of_seed = {{"level", observe_level},
                                                 {"weights", observe_weights},
                                                 {"tail", observe_tail},
                                                 {"simulated", study_simulations}};
  std::string path = std::string(DISCOVERY_TESTS) + "/recorded/micro.txt", what;
  for (const std::string &option : options.others)
    if (option.rfind("table=", 0) == 0)
      path = option.substr(6);
    else if (of_seed.count(option) > 0 || option == "describe" || option == "ideal")
      what = option;
    else
      throw std::runtime_error("unknown option " + option);
  const RecordedTable table(path);
  if (what == "describe")
    return describe(table);
  if (what == "ideal")
    return observe(table, options);
  for (std::uint32_t k = 0; k < options.n_seeds; ++k) {
    const std::uint32_t seed = options.first_seed + k;
    if (!what.empty()) {
      of_seed.at(what)(table, options.study, seed);
      continue;
    }
    for (const StudyKind &kind : standard_kinds())
      if (options.wants(kind) && kind.kind != "confounded") {
        const RecordedStudy study = interpolated_study(table, kind, seed, options.study);
        print_outcome(study.one, study.discovery);
      }
  }
}

} // namespace

int main(int argc, char **argv)
{
  return run_suite(argc, argv, run);
}
