#include <eunoe/core/parameter_section.h>
#include <eunoe/discovery/inference/design.h>
#include <eunoe/discovery/inference/held_out.h>
#include <eunoe/discovery/inference/learning_curve.h>
#include <eunoe/discovery/inference/plan.h>
#include <eunoe/discovery/inference/predictive.h>

#include <boost/algorithm/string/join.hpp>

#include <algorithm>
#include <map>
#include <memory>

namespace eunoe::discovery {

namespace {

/// One round of a study: what all runs so far say.
struct Round
{
  Round(const std::vector<MeasuredExperiment> &measured, const Samples &samples,
        const StudyOptions &options, const DecisionRule &rule)
      : target(measured, samples, options.model_tolerance), evidence(target, samples.space()),
        options(options)
  {
    look(rule);
  }

  void look(const DecisionRule &rule)
  {
    findings = weigh(evidence, options, rule);
    if (!findings.detected)
      return;
    choose(rule, findings);
    judge(evidence, rule, options.seed, findings);
  }

  Target target;
  Evidence evidence;
  Findings findings;

private:
  const StudyOptions &options;
};

/// Whether the last rounds gave the same answer, and the errors of the emulators no longer matter
/// for it.
bool is_settled(const Json &curve, const Round &round, const double level)
{
  const Findings &findings = round.findings;
  if (!is_steady(curve, level) || (findings.detected ? has_challenger(round.evidence, findings)
                                                     : could_be_detected(round.evidence, findings)))
    return false;
  // More runs do not tell an effect from one like it that the catalogue lacks.
  const Model &first = findings.models.front();
  const double of_all = first.is_discrepancy ? 1. : 1. - findings.off_catalogue;
  if (!findings.detected || first.probability > tuned::ending::sure * of_all)
    return true;
  double largest = 0.;
  for (const Model &model : findings.answer)
    largest = std::max(largest, round.target.unknown_share(round.target.predict(model.best)));
  return largest < tuned::ending::well_known;
}

/// Verdict where nothing was detected: whether most effects would have been. Those that were never
/// simulated would not.
Verdict verdict_without_detection(const Json &power)
{
  const auto seen = std::count_if(power.begin(), power.end(), [](const Json &row) {
    return row.at("simulated").get<bool>() && row.at("detectable").get<bool>();
  });
  return 2 * seen >= static_cast<std::ptrdiff_t>(power.size()) ? Verdict::none
                                                               : Verdict::underpowered;
}

/// What the residuals resemble where no effect of the catalogue explains them.
Json describe_remainder(const Evidence &evidence, const Findings &findings)
{
  const Eigen::VectorXd deviation = evidence.target().data() - evidence.nothing().prediction.mean;
  std::vector<std::pair<double, Json>> rows;
  for (std::size_t k = 0; k < evidence.space().n_effects(); ++k) {
    double largest = 0.;
    for (const Evidence::Place &place : evidence.places(k)) {
      const Eigen::VectorXd change = evidence.change(place.hypothesis.prediction);
      largest = std::max(largest, change.dot(deviation) /
                                      std::max(change.norm() * deviation.norm(), 1e-300));
    }
    if (largest > 0.)
      rows.emplace_back(largest, Json{{"effect", evidence.space().effect(k).name},
                                      {"mechanism", evidence.space().effect(k).mechanism},
                                      {"cosine", largest}});
  }
  constexpr std::size_t most = 3;
  const Model *const closest = closest_model(findings);
  return {{"closest model", closest ? Json(name_of(*closest, evidence.space())) : Json(nullptr)},
          {"p of its fit", closest ? Json(findings.p_fit) : Json(nullptr)},
          {"resembles", largest_first(std::move(rows), most)}};
}

Json describe_nuisances(const FactorSpace &space, const Eigen::VectorXd &values)
{
  Json rows = Json::array();
  for (std::size_t q = 0; q < space.n_nuisances(); ++q) {
    const Factor &nuisance = space.nuisance(q);
    const double shift = values(static_cast<Eigen::Index>(q));
    rows.push_back({{"nuisance", nuisance.name},
                    {"value", nuisance.null_value + shift * nuisance.prior_deviation},
                    {"prior deviations", shift}});
  }
  return rows;
}

Json describe_calibration(const Findings &findings, const FactorSpace &space)
{
  const Calibration &c = findings.calibration;
  Json lookalikes = nullptr;
  if (findings.detected) {
    Json taken_for = Json::object();
    for (const auto &[k, share] : findings.lookalikes.taken_for)
      taken_for[space.effect(k).name] = share;
    lookalikes = {{"strength", findings.lookalikes.strength},
                  {"recognised", findings.lookalikes.recognised},
                  {"taken for", taken_for}};
  }
  return {
      {"lookalikes", lookalikes}, {"twins", c.twins}, {"temperature", c.temperature},
      {"mean stated", c.stated},  {"right", c.right}, {"coverage of plain intervals", c.coverage},
      {"interval", c.interval}};
}

/// Everything that the page says of the data of the fit, and what validation says beside it.
Json describe_fit(const Round &round, const StudyOptions &options, const Json &validation)
{
  const Evidence &evidence = round.evidence;
  const Findings &findings = round.findings;
  const auto fitted = [&](const EffectPositions &effects) {
    const Eigen::VectorXd best = nuisances_given(evidence, effects).mean;
    return std::pair(fit_to(round.target, effects, best), best);
  };
  const auto [base, base_nuisances] = fitted({});
  Eigen::VectorXd values = base_nuisances;
  std::optional<Fitted> after, second;
  if (const Model *const first = closest_model(findings); findings.detected && first) {
    std::tie(after.emplace(), values) = fitted(first->best);
    for (const Model &model : findings.models)
      if (!second && model.effects.size() == 1 && model.effects != first->effects)
        second = fitted(model.best).first;
  }
  return {{"nuisances", describe_nuisances(evidence.space(), values)},
          {"gaps", {{"fit", describe_gap(base, after)}, {"held-out", validation}}},
          {"envelopes", describe_envelopes(round.target, base, after, options.level)},
          {"decisive", after && second ? decisive_points(*after, *second)
                       : after         ? decisive_points(*after, base)
                                       : Json::array()}};
}

/// A study while it is made.
class Study
{
public:
  Study(const StudyOptions &options, const MeasuredData &data, const std::vector<Factor> &factors,
        Simulator &simulator, Log &log)
      : options(options), data(data), space(factors), log(log), fit(experiments_of(data.fit)),
        samples(options, space, simulator, all_experiments()),
        held_out(options, rule, data, samples), design(options, space, samples, fit)
  {
    if (samples.n_known() > 0)
      log.line("  " + std::to_string(samples.n_known()) + " runs are in the table already");
  }

  void run();
  Discovery answer();

private:
  std::vector<std::string> all_experiments() const
  {
    std::vector<std::string> all = fit;
    for (const auto &more : {experiments_of(data.held_out), options.further_experiments})
      all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  std::uint64_t n_runs() const { return samples.n_known() + samples.n_asked(); }
  /// Keeps runs for the tests of the answer: at most half of what the base model has left of the
  /// budget, as without an answer there is nothing to test.
  /// @return how many
  std::uint64_t keep_for_tests();
  /// Whether a measured experiment can have an effect.
  bool can_be_seen(std::size_t effect) const;
  /// Says which effects the answer does not judge, or not everywhere, and why.
  void note_what_was_not_run();
  /// Effects that could be what is missing, but of which there is no result.
  std::vector<std::string> untried() const;
  Json describe(const Json &power, const Json &of_fit);

  const StudyOptions &options;
  const MeasuredData &data;
  const DecisionRule rule;
  const FactorSpace space;
  Log &log;
  const std::vector<std::string> fit;
  Samples samples;
  HeldOut held_out;
  Design design;
  std::vector<std::string> notes;
  Json curve = Json::array();
  std::unique_ptr<Round> round;
};

std::uint64_t Study::keep_for_tests()
{
  const std::uint64_t wanted =
      held_out.n_runs() + runs_to_test(tuned::plan::most_models, options.validate_runs,
                                       options.further_experiments, samples);
  const std::uint64_t kept = std::min(wanted, samples.remaining() / tuned::held_out::kept_one_in);
  samples.set_aside(kept);
  return kept;
}

/// First runs, then rounds of runs where they are expected to tell most.
void Study::run()
{
  design.run_base();
  const std::uint64_t kept = keep_for_tests();
  if (data.fit.empty())
    throw UserError("Nothing that was measured is to be fitted, so nothing can be compared.");
  const auto measured = sort_by_experiment(data.fit, samples);
  design.run_effects([&] { return Target(measured, samples, options.model_tolerance); });
  bool settled = false;
  while (true) {
    round = std::make_unique<Round>(measured, samples, options, rule.quick());
    const Findings &findings = round->findings;
    curve.push_back(describe_round(findings, space, n_runs()));
    const Json &last = curve.back();
    log.line("  " + std::to_string(n_runs()) + " runs: " + last["verdict"].get<std::string>() +
             (findings.detected ? ", first " + last["first"].get<std::string>() + " (" +
                                      format(last["probability"].get<double>()) + ")"
                                : ", p = " + format(findings.p_nothing)));
    // Who knows which effect it is still has to learn how much of it.
    settled = is_settled(curve, *round, options.level);
    if (settled ? !design.sharpen(round->evidence, findings.answer)
                : !design.refine(round->evidence, findings))
      break;
  }
  if (!settled)
    notes.push_back((kept == 0 ? "The budget of " + std::to_string(options.budget) + " runs was"
                               : "Of the budget of " + std::to_string(options.budget) + " runs " +
                                     std::to_string(kept) +
                                     " are kept for tests of the answer, and the rest was") +
                    " spent before the answer had settled. With a larger 'budget of runs' the "
                    "study goes on from here, and the answer may change.");
  round->look(rule);
}

bool Study::can_be_seen(const std::size_t effect) const
{
  return std::any_of(fit.begin(), fit.end(), [&](const std::string &experiment) {
    return samples.simulator().concerns(experiment, {space.effect(effect).name});
  });
}

void Study::note_what_was_not_run()
{
  std::map<std::string, std::vector<std::string>> without; // effects, by what was in the way
  for (std::size_t k = 0; k < space.n_effects(); ++k) {
    const std::string &name = space.effect(k).name;
    if (round->evidence.places(k).empty()) {
      without[!can_be_seen(k) ? "No experiment that was measured can have these effects"
              : samples.has_failed(k, fit)
                  ? "All runs with these effects failed (the list of failed runs says why)"
                  : "These effects were never simulated, as the runs for "
                    "the fit were spent before"]
          .push_back(name);
      continue;
    }
    for (const std::string &experiment : fit)
      if (!samples.has_any(k, {experiment}))
        notes.push_back("There is no result of '" + experiment + "' with the effect '" + name +
                        "', so it is taken to change nothing there.");
  }
  for (const auto &[reason, names] : without)
    notes.push_back(reason + ", so the answer says nothing of them: " + boost::join(names, ", ") +
                    ".");
}

std::vector<std::string> Study::untried() const
{
  std::vector<std::string> names;
  for (std::size_t k = 0; k < space.n_effects(); ++k)
    if (round->evidence.places(k).empty() && can_be_seen(k))
      names.push_back(space.effect(k).name);
  return names;
}

Json Study::describe(const Json &power, const Json &of_fit)
{
  const Findings &findings = round->findings;
  const Evidence &evidence = round->evidence;
  const bool is_tie = findings.verdict == Verdict::tie;
  constexpr std::size_t most = 8;
  std::vector<Model> likeliest = findings.models;
  likeliest.resize(std::min(most, likeliest.size()));
  Json c = {{"verdict", name_of(findings.verdict)},
            {"exit code", exit_code(findings.verdict)},
            {"detected", findings.detected},
            {"p of nothing missing", findings.p_nothing},
            {"log Bayes factor", findings.log_bayes_factor},
            {"untried", untried()},
            {"confidence off catalogue", findings.detected ? findings.off_catalogue : 0.}};
  c["candidates"] = describe_candidates(evidence, findings);
  c["amplitudes"] = describe_amplitudes(evidence, findings);
  c["p of the fit"] = findings.p_fit;
  c["tie"] = is_tie ? describe_models(findings.answer, space) : Json::array();
  if (is_tie && findings.none_of_these)
    c["tie"].push_back(
        {{"effects", "none of the catalogue"}, {"probability", findings.off_catalogue}});
  c["measurements that would break the tie"] =
      is_tie ? plan_for_tie(evidence, findings, options, samples) : Json::array();
  c["remainder"] = findings.verdict == Verdict::off_catalogue
                       ? describe_remainder(evidence, findings)
                       : Json::object();
  c["models"] = describe_models(likeliest, space);
  c.update(of_fit);
  c["effects"] = power;
  c.update(describe_fingerprints(evidence));
  c["calibration"] = describe_calibration(findings, space);
  c["learning curve"] = curve;
  c["runs"] = {{"known", samples.n_known()},
               {"asked for", samples.n_asked()},
               {"failed", samples.n_failed()},
               {"budget", options.budget}};
  c["notes"] = notes;
  return c;
}

Discovery Study::answer()
{
  Findings &findings = round->findings;
  const Json power = describe_power(round->evidence, findings, options.seed);
  if (!findings.detected)
    findings.verdict = verdict_without_detection(power);
  note_what_was_not_run();
  samples.set_aside(0);
  const Json validation = held_out.test(round->evidence, findings);
  allow_for_untried(untried().size(), space.n_effects(), findings);
  Discovery discovery;
  discovery.content = describe(power, describe_fit(*round, options, validation));
  discovery.verdict = findings.verdict;
  if (findings.verdict == Verdict::named || findings.verdict == Verdict::tie)
    for (const auto &[k, position] : findings.answer.front().best)
      discovery.model_after[space.effect(k).name] =
          space.effect(k).null_value + position * space.effect(k).scale;
  log.line("Verdict: " + name_of(findings.verdict));
  return discovery;
}

} // namespace

Discovery discover(const StudyOptions &options, const MeasuredData &data,
                   const std::vector<Factor> &factors, Simulator &simulator, Log &log)
{
  Study study(options, data, factors, simulator, log);
  study.run();
  return study.answer();
}

} // namespace eunoe::discovery
