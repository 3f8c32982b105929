#include <eunoe/core/problems.h>
#include <eunoe/discovery/inference/held_out.h>
#include <eunoe/discovery/inference/plan.h>

#include <algorithm>

namespace eunoe::discovery {

namespace {

using tuned::held_out::most_tested;
/// Places in a contest.
constexpr std::size_t base = 0, first = 1;

/// Places in a contest of the models that share no effect with one of them.
std::vector<std::size_t> others(const std::size_t model, const std::vector<Model> &models)
{
  const std::vector<std::size_t> &own = models[model].effects;
  std::vector<std::size_t> result;
  for (std::size_t m = 0; m < models.size(); ++m)
    if (std::find_first_of(own.begin(), own.end(), models[m].effects.begin(),
                           models[m].effects.end()) == own.end())
      result.push_back(first + m);
  return result;
}

std::string sentence(const double p_before, const double p_after, const double level)
{
  if (p_after < level)
    return "the held-out data refute it; the name is withdrawn";
  return p_before < level ? "the base model is refuted, this one describes the data"
                          : "both models describe the held-out data";
}

} // namespace

HeldOut::HeldOut(const StudyOptions &options, const DecisionRule &rule, const MeasuredData &data,
                 Samples &samples)
    : options(options), rule(rule), data(data), samples(samples),
      experiments(experiments_of(data.held_out))
{
}

std::uint64_t HeldOut::n_runs() const
{
  return runs_to_test(most_tested, options.validate_runs, experiments, samples);
}

HeldOut::Test HeldOut::compare(const Evidence &fit, const std::vector<Model> &wanted,
                               const unsigned int runs)
{
  run_near(fit, wanted, runs, experiments, samples);
  std::vector<Model> models;
  std::copy_if(wanted.begin(), wanted.end(), std::back_inserter(models), [&](const Model &model) {
    return std::all_of(model.effects.begin(), model.effects.end(),
                       [&](const std::size_t k) { return samples.has_any(k, experiments); });
  });
  Target target(sort_by_experiment(data.held_out, samples), samples, options.model_tolerance);
  std::vector<Predictive> all;
  const auto add = [&](const Model &model) {
    all.emplace_back(target, draw_posterior(fit, model, rule.predictive_draws, options.seed),
                     options.seed + 3);
  };
  add({});
  for (const Model &model : models)
    add(model);
  Contest contest(std::move(all));
  const auto p = [&](const std::size_t place) { return contest.p(place, target.data()); };
  TestedModels tested = {models, {}, {}, p(base)};
  for (std::size_t m = 0; m < models.size(); ++m) {
    tested.p.push_back(p(first + m));
    tested.passes.push_back(contest.passes(first + m, others(m, models), rule.refuted));
  }
  return {std::move(target), std::move(contest), std::move(tested)};
}

bool HeldOut::is_doubtful(const TestedModels &tested, const std::vector<Model> &answer) const
{
  const double clearly = tuned::held_out::clearly * rule.refuted,
               hardly = tuned::held_out::hardly * rule.doubtful;
  for (std::size_t m = 0; m < tested.models.size(); ++m)
    if (tested.p[m] > clearly && tested.p[m] < hardly && is_among(tested.models[m], answer))
      return true;
  return false;
}

std::vector<Model> HeldOut::first_tested(const Findings &by_fit) const
{
  std::vector<Model> wanted = by_fit.answer;
  if (by_fit.detected)
    for (const Model &model : by_fit.models)
      if (wanted.size() < most_tested && model.effects.size() == 1 && !is_among(model, wanted))
        wanted.push_back(model);
  std::vector<Model> models;
  add(wanted, most_tested, models);
  return models;
}

void HeldOut::add(const std::vector<Model> &wanted, const std::size_t most,
                  std::vector<Model> &models) const
{
  const auto runs_of = [&](const std::size_t n_effects) {
    return runs_to_test(static_cast<unsigned int>(n_effects), options.validate_runs, experiments,
                        samples);
  };
  const std::size_t before = models.size();
  // Those of the base model are made once for all.
  const std::uint64_t of_base = runs_of(0);
  std::uint64_t planned = of_base;
  for (const Model &model : wanted) {
    if (models.size() == before + most)
      break;
    if (is_among(model, models))
      continue;
    // Of what was never run nothing could be said but that it changes nothing.
    const bool is_known = std::all_of(model.best.begin(), model.best.end(), [&](const auto &at) {
      return samples.has_near(at.first, at.second, 1, experiments);
    });
    const std::uint64_t needed = is_known ? 0 : runs_of(model.effects.size()) - of_base;
    if (!is_known && planned + needed > samples.remaining())
      continue;
    planned += needed;
    models.push_back(model);
  }
}

Json HeldOut::describe_test(const Test &test, const Findings &by_fit,
                            const std::optional<std::size_t> &leader) const
{
  const TestedModels &tested = test.tested;
  Json table = {{"p before", tested.p_nothing}};
  if (by_fit.verdict == Verdict::named || by_fit.verdict == Verdict::tie) {
    Json members = Json::array();
    for (std::size_t m = 0; m < tested.models.size(); ++m)
      if (is_among(tested.models[m], by_fit.answer))
        members.push_back({{"effects", name_of(tested.models[m], samples.space())},
                           {"p", tested.p[m]},
                           {"result", sentence(tested.p_nothing, tested.p[m], rule.refuted)}});
    table["members of the tie"] = members;
    table["result"] = leader ? sentence(tested.p_nothing, tested.p[*leader], rule.refuted)
                             : "the likeliest model that they leave was not tested";
  } else
    table["result"] = tested.p_nothing < rule.refuted
                          ? "the base model does not describe the held-out data"
                          : "the base model describes the held-out data";
  if (tested.models.empty())
    return table;
  if (leader)
    table["p after"] = tested.p[*leader];
  Json refutable = Json::array();
  const auto add = [&](const std::string &effects, const double p, const std::size_t place) {
    refutable.push_back({{"effects", effects},
                         {"p", p},
                         {"would be refuted", leader ? Json(test.contest.refuted_by(
                                                           place, first + *leader, rule.refuted))
                                                     : Json(nullptr)}});
  };
  add("nothing", tested.p_nothing, base);
  for (std::size_t m = 0; m < tested.models.size(); ++m)
    if (m != leader)
      add(name_of(tested.models[m], samples.space()), tested.p[m], first + m);
  table["could have refuted"] = refutable;
  return table;
}

Json HeldOut::test(const Evidence &evidence, Findings &findings)
{
  if (experiments.empty())
    return {{"result", "no held-out data"}};
  const auto judge_anew = [&](Findings &anew) { judge(evidence, rule, options.seed, anew); };
  const Findings by_fit = findings;
  std::vector<Model> models = first_tested(by_fit);
  if (!by_fit.answer.empty() && !is_among(by_fit.answer.front(), models))
    return {{"result", "the budget has no room to test the answer on held-out data"}};
  std::optional<Test> last;
  std::size_t n_compared = 0;
  for (unsigned int round = 0; round < tuned::held_out::most_rounds; ++round) {
    if (round > 0 && models.size() == n_compared)
      break;
    n_compared = models.size();
    try {
      Test test = compare(evidence, models, options.validate_runs);
      if (is_doubtful(test.tested, by_fit.answer))
        test = compare(evidence, models, tuned::held_out::in_doubt * options.validate_runs);
      if (!by_fit.answer.empty() && !is_among(by_fit.answer.front(), test.tested.models))
        return {{"result", "no run of the held-out experiments with the answer's effects gave all "
                           "that was measured, so it was not tested"}};
      last = std::move(test);
    } catch (const TooFewRuns &) {
      if (round == 0)
        return {{"result", "the held-out experiments could not be simulated"}};
      break;
    }
    Findings left = by_fit;
    refute(last->tested, Untested::stay, rule, judge_anew, left);
    if (left.verdict != Verdict::off_catalogue)
      add(left.answer, tuned::held_out::most_followed, models);
  }
  const std::optional<std::size_t> leader =
      refute(last->tested, Untested::fall, rule, judge_anew, findings);

  const Target &held_out = last->target;
  const auto fitted = [&](const Model &model) {
    return fit_to(held_out, model.best, nuisances_given(evidence, model.best).mean);
  };
  std::optional<Fitted> after;
  if (leader)
    after = fitted(last->tested.models[*leader]);
  const Fitted before = fitted({});
  Json table = describe_gap(before, after);
  table.update(describe_test(*last, by_fit, leader));
  table["envelopes"] = describe_envelopes(held_out, before, after, options.level);
  return table;
}

} // namespace eunoe::discovery
