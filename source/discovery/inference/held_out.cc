#include <eunoe/core/problems.h>
#include <eunoe/discovery/inference/held_out.h>
#include <eunoe/discovery/inference/plan.h>

#include <algorithm>

namespace eunoe::discovery {

namespace {

/// Models that are tested: those of the answer, and others that held-out data might speak for.
constexpr std::size_t most_tested = 4;
/// And in each further round of the rest of the answer, where it has many models or others have
/// taken the place of refuted ones.
constexpr std::size_t most_followed = 3;
constexpr unsigned int most_rounds = 3;
/// Where the result is in doubt, this many times the runs, as far as the budget has room.
constexpr unsigned int in_doubt = 3;
/// Places in a contest.
constexpr std::size_t base = 0, first = 1;

bool is_among(const Model &model, const std::vector<Model> &models)
{
  return std::any_of(models.begin(), models.end(),
                     [&](const Model &other) { return other.effects == model.effects; });
}

/// Models that nothing has tested and that the fit finds no likelier than a refuted model without
/// one of their effects. That effect would have to mend what the data of the fit do not show.
std::vector<Model> falling_with(const std::vector<Model> &refuted, const std::vector<Model> &tested,
                                const std::vector<Model> &all)
{
  std::vector<Model> result;
  for (auto model = all.begin(); model != all.end(); ++model)
    if (!model->is_discrepancy && !is_among(*model, tested) &&
        std::any_of(all.begin(), model, [&](const Model &likelier) {
          return is_among(likelier, refuted) &&
                 std::includes(model->effects.begin(), model->effects.end(),
                               likelier.effects.begin(), likelier.effects.end());
        }))
      result.push_back(*model);
  return result;
}

/// Of an answer to which the data of the fit gave little, what nothing has tested goes.
void keep_tested(const std::vector<Model> &tested, Findings &findings)
{
  std::vector<Model> &answer = findings.answer;
  answer.erase(std::remove_if(answer.begin(), answer.end(),
                              [&](const Model &model) { return !is_among(model, tested); }),
               answer.end());
  findings.verdict = answer.empty() ? Verdict::off_catalogue : findings.verdict;
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

std::unique_ptr<HeldOut::Comparison> HeldOut::compare(const Evidence &fit,
                                                      const std::vector<Model> &models,
                                                      const unsigned int runs)
{
  run_near(fit, models, runs, space, experiments, samples);
  std::vector<std::string> notes;
  const auto measured = sort_by_experiment(data.held_out, samples, samples.simulator(), notes);
  if (measured.empty())
    return nullptr;
  return std::make_unique<Comparison>(
      Target(measured, samples, space, options.model_tolerance), space,
      [&](const Evidence &held_out) {
        std::vector<Predictive> all;
        const auto add = [&](const Model &model) {
          all.emplace_back(held_out,
                           draw_posterior(fit, model, rule.predictive_draws, options.seed),
                           options.seed + 3);
        };
        add({});
        for (const Model &model : models)
          add(model);
        return Contest(std::move(all));
      });
}

bool HeldOut::is_doubtful(const Comparison &comparison, const std::size_t n_answers) const
{
  const double clearly = 0.1 * rule.refuted, hardly = 4. * rule.doubtful;
  for (std::size_t m = 0; m < n_answers; ++m) {
    const double p = comparison.p(first + m);
    if (p > clearly && p < hardly)
      return true;
  }
  return false;
}

Json HeldOut::test_models(const Evidence &fit, const Comparison &comparison,
                          const std::vector<Model> &models, const bool is_last,
                          Findings &findings) const
{
  const double p_base = comparison.p(base);
  Json table = {{"p before", p_base}};
  std::vector<double> p;
  for (std::size_t m = 0; m < models.size(); ++m)
    p.push_back(comparison.p(first + m));
  const bool is_answered = findings.verdict == Verdict::named || findings.verdict == Verdict::tie;
  const std::size_t n_members = is_answered ? std::min(models.size(), findings.answer.size()) : 0;
  std::vector<Model> refuted;
  Json members = Json::array();
  for (std::size_t m = 0; m < models.size(); ++m) {
    if (p[m] < rule.refuted)
      refuted.push_back(models[m]);
    if (m < n_members)
      members.push_back({{"effects", name_of(models[m], space)},
                         {"p", p[m]},
                         {"result", sentence(p_base, p[m], rule.refuted)}});
  }
  // A new answer is made of models that were tested: what leads the rest is likely only beside
  // others as unlikely.
  const std::vector<Model> by_fit = findings.answer;
  const bool is_all_refuted = std::all_of(
      by_fit.begin(), by_fit.end(), [&](const Model &model) { return is_among(model, refuted); });
  if (is_last || is_all_refuted)
    for (const Model &model : falling_with(refuted, models, findings.models))
      refuted.push_back(model);
  std::optional<std::size_t> front; // that leads the answer, if it was tested
  if (!models.empty())
    front = 0;
  if (is_answered) {
    withdraw(refuted, rule, findings);
    if (is_last && is_all_refuted)
      keep_tested(models, findings);
    if (findings.verdict == Verdict::off_catalogue)
      findings.answer = by_fit;
    else if (!findings.answer.empty()) {
      front.reset();
      for (std::size_t m = 0; m < models.size() && !front; ++m)
        if (models[m].effects == findings.answer.front().effects)
          front = m;
      if (front != 0)
        judge(fit, rule, options.seed, findings);
    }
    if (findings.verdict != Verdict::off_catalogue) {
      findings.none_of_these |= !front || p[*front] < rule.doubtful;
      findings.verdict = verdict_of(findings);
    }
    table["members of the tie"] = members;
    table["result"] = front ? sentence(p_base, p[*front], rule.refuted)
                            : "the likeliest model that they leave was not tested";
  } else
    table["result"] = p_base < rule.refuted ? "the base model does not describe the held-out data"
                                            : "the base model describes the held-out data";
  if (models.empty())
    return table;
  if (front)
    table["p after"] = p[*front];
  const auto by_front = [&](const std::size_t place) {
    return front ? Json(comparison.contest.refuted_by(place, first + *front, rule.refuted))
                 : Json(nullptr);
  };
  Json refutable = {{{"effects", "nothing"}, {"p", p_base}, {"would be refuted", by_front(base)}}};
  for (std::size_t m = 0; m < models.size(); ++m)
    if (m != front)
      refutable.push_back({{"effects", name_of(models[m], space)},
                           {"p", p[m]},
                           {"would be refuted", by_front(first + m)}});
  table["could have refuted"] = refutable;
  return table;
}

void HeldOut::follow(const std::vector<Model> &answer, std::vector<Model> &models) const
{
  const std::size_t before = models.size();
  std::uint64_t planned = 0;
  for (const Model &model : answer) {
    if (models.size() == before + most_followed)
      break;
    if (is_among(model, models))
      continue;
    const std::uint64_t needed = runs_to_test(static_cast<unsigned int>(model.effects.size()),
                                              options.validate_runs, space, experiments, samples);
    const bool is_known = std::all_of(model.best.begin(), model.best.end(), [&](const auto &at) {
      return samples.has_near(at.first, at.second, 1, experiments);
    });
    if (!is_known && planned + needed > samples.remaining())
      continue;
    planned += is_known ? 0 : needed;
    models.push_back(model);
  }
}

Json HeldOut::test(const Evidence &evidence, Findings &findings)
{
  if (experiments.empty())
    return {{"result", "no held-out data"}};
  std::vector<Model> models = findings.answer;
  if (findings.detected)
    for (const Model &model : findings.models)
      if (models.size() < most_tested && model.effects.size() == 1 && !is_among(model, models))
        models.push_back(model);
  if (models.size() > most_tested)
    models.resize(most_tested);
  const Findings by_fit = findings;
  std::unique_ptr<Comparison> comparison;
  Json tested;
  std::size_t n_tested = 0;
  bool go_on = true;
  for (unsigned int round = 0; go_on && round < most_rounds; ++round) {
    try {
      comparison = compare(evidence, models, options.validate_runs);
      if (comparison && is_doubtful(*comparison, std::min(models.size(), by_fit.answer.size())))
        comparison = compare(evidence, models, in_doubt * options.validate_runs);
    } catch (const UserError &) {
      if (round == 0)
        return {{"result", "the held-out experiments could not be simulated"}};
      break;
    }
    if (!comparison)
      return {{"result", "the held-out data do not vary"}};
    findings = by_fit;
    tested = test_models(evidence, *comparison, models, false, findings);
    n_tested = models.size();
    if (findings.verdict != Verdict::off_catalogue)
      follow(findings.answer, models);
    go_on = models.size() > n_tested;
  }
  models.resize(n_tested);
  findings = by_fit;
  tested = test_models(evidence, *comparison, models, true, findings);
  const Evidence &held_out = comparison->evidence;

  const auto fitted = [&](const Model &model) {
    const Eigen::VectorXd nuisances =
        best_nuisances(evidence, evidence.prepare(evidence.target().predict(model.best)));
    return fit_to(held_out, model.best, nuisances);
  };
  std::optional<Fitted> after;
  if (!models.empty())
    after = fitted(findings.answer.empty() ? models.front() : findings.answer.front());
  const Fitted before = fitted({});
  Json table = describe_gap(held_out, before, after);
  table.update(tested);
  table["envelopes"] = describe_envelopes(held_out, before, after, options.level);
  return table;
}

} // namespace eunoe::discovery
