#include <eunoe/core/problems.h>
#include <eunoe/discovery/inference/held_out.h>
#include <eunoe/discovery/inference/plan.h>

#include <algorithm>

namespace eunoe::discovery {

namespace {

/// Models that are tested: those of the answer, and others that held-out data might speak for.
constexpr std::size_t most_tested = 4;
/// Where the result is in doubt, this many times the runs, as far as the budget has room.
constexpr unsigned int in_doubt = 3;

std::string sentence(const double p_before, const double p_after, const double level)
{
  if (p_after < level)
    return "it does not describe the held-out data; the name is withdrawn";
  return p_before < level ? "the base model is refuted, this one describes the data"
                          : "both models describe the held-out data";
}

} // namespace

HeldOut::HeldOut(const StudyOptions &options, const DecisionRule &rule, const MeasuredData &data,
                 const FactorSpace &space, Samples &samples)
    : options(options), rule(rule), data(data), space(space), samples(samples)
{
  for (const MeasuredPoint &point : data.held_out)
    if (std::find(experiments.begin(), experiments.end(), point.point.experiment) ==
        experiments.end())
      experiments.push_back(point.point.experiment);
}

std::uint64_t HeldOut::n_runs() const
{
  return runs_to_test(most_tested, options.validate_runs, space, experiments, samples);
}

Contest HeldOut::predict(const Evidence &fit, const Evidence &held_out,
                         const std::vector<Model> &models) const
{
  std::vector<Predictive> all;
  const auto add = [&](const Model &model) {
    all.emplace_back(held_out, draw_posterior(fit, model, rule.predictive_draws, options.seed),
                     options.seed + 3);
  };
  add({});
  for (const Model &model : models)
    add(model);
  return Contest(std::move(all));
}

bool HeldOut::is_doubtful(const Evidence &fit, const Evidence &held_out,
                          const std::vector<Model> &models, const Findings &findings) const
{
  const double clearly = 0.1 * rule.refuted, hardly = 4. * rule.doubtful;
  const Contest contest = predict(fit, held_out, models);
  for (std::size_t m = 0; m < std::min(models.size(), findings.answer.size()); ++m) {
    const double p = contest.p(m + 1, held_out.target().data());
    if (p > clearly && p < hardly)
      return true;
  }
  return false;
}

Json HeldOut::test_models(const Evidence &fit, const Evidence &held_out,
                          const std::vector<Model> &models, Findings &findings) const
{
  const Eigen::VectorXd &measured = held_out.target().data();
  const Contest contest = predict(fit, held_out, models);
  constexpr std::size_t base = 0, first = 1; // places in the contest
  const double p_base = contest.p(base, measured);
  Json table = {{"p before", p_base}};
  Json members = Json::array(), refutable = Json::array();
  std::vector<Model> kept;
  const bool is_answered = findings.verdict == Verdict::named || findings.verdict == Verdict::tie;
  for (std::size_t m = 0; m < models.size(); ++m) {
    const double p = contest.p(first + m, measured);
    const bool in_answer = m < findings.answer.size();
    if (in_answer && is_answered) {
      members.push_back({{"effects", name_of(models[m], space)},
                         {"p", p},
                         {"result", sentence(p_base, p, rule.refuted)}});
      if (p >= rule.refuted)
        kept.push_back(models[m]);
      findings.none_of_these |= m == 0 && p < rule.doubtful;
    }
    if (m == 0)
      table["p after"] = p;
    else
      refutable.push_back(
          {{"effects", name_of(models[m], space)},
           {"p", p},
           {"would be refuted", contest.refuted_by(first + m, first, rule.refuted)}});
  }
  if (!models.empty()) {
    const Json nothing = {{"effects", "nothing"},
                          {"p", p_base},
                          {"would be refuted", contest.refuted_by(base, first, rule.refuted)}};
    refutable.insert(refutable.begin(), nothing);
  }
  table["could have refuted"] = refutable;
  if (!is_answered) {
    table["result"] = p_base < rule.refuted ? "the base model does not describe the held-out data"
                                            : "the base model describes the held-out data";
    return table;
  }
  // Those that were not tested stay.
  for (std::size_t m = models.size(); m < findings.answer.size(); ++m)
    kept.push_back(findings.answer[m]);
  table["members of the tie"] = members;
  table["result"] = members[0]["result"];
  // Models that the data refute leave; if none is left, so does the name.
  if (kept.empty())
    findings.verdict = Verdict::off_catalogue;
  else {
    findings.answer = kept;
    findings.verdict = kept.size() == 1 && !findings.none_of_these ? Verdict::named : Verdict::tie;
  }
  return table;
}

Json HeldOut::test(const Evidence &evidence, Findings &findings)
{
  if (experiments.empty())
    return {{"result", "no held-out data"}};
  std::vector<Model> models = findings.answer;
  if (findings.detected)
    for (const Model &model : findings.models)
      if (models.size() < most_tested && model.effects.size() == 1 &&
          std::none_of(models.begin(), models.end(),
                       [&](const Model &m) { return m.effects == model.effects; }))
        models.push_back(model);
  if (models.size() > most_tested)
    models.resize(most_tested);
  std::vector<std::string> notes;
  const auto run_and_compare = [&](const unsigned int runs) -> std::optional<Target> {
    run_near(evidence, models, runs, space, experiments, samples);
    const auto measured = sort_by_experiment(data.held_out, samples, samples.simulator(), notes);
    return measured.empty()
               ? std::nullopt
               : std::make_optional<Target>(measured, samples, space, options.model_tolerance);
  };
  std::optional<Target> target;
  try {
    target = run_and_compare(options.validate_runs);
    if (target && is_doubtful(evidence, Evidence(*target, space), models, findings))
      target = run_and_compare(in_doubt * options.validate_runs);
  } catch (const UserError &) {
    return {{"result", "the held-out experiments could not be simulated"}};
  }
  if (!target)
    return {{"result", "the held-out data do not vary"}};
  const Evidence held_out(*target, space);
  const Json tested = test_models(evidence, held_out, models, findings);

  const auto fitted = [&](const Model &model) {
    const Eigen::VectorXd nuisances =
        best_nuisances(evidence, evidence.prepare(evidence.target().predict(model.best)));
    return fit_to(held_out, model.best, nuisances);
  };
  std::optional<Fitted> after;
  if (!models.empty())
    after = fitted(findings.answer.empty() ? models.front() : findings.answer.front());
  const Fitted base = fitted({});
  Json table = describe_gap(held_out, base, after);
  table.update(tested);
  table["envelopes"] = describe_envelopes(held_out, base, after, options.level);
  return table;
}

} // namespace eunoe::discovery
