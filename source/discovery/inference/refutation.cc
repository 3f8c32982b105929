#include <eunoe/discovery/inference/refutation.h>

#include <algorithm>

namespace eunoe::discovery {

namespace {

bool is_all_among(const std::vector<Model> &some, const std::vector<Model> &models)
{
  return std::all_of(some.begin(), some.end(),
                     [&](const Model &model) { return is_among(model, models); });
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
          return is_among(likelier, refuted) && is_part(likelier, *model);
        }))
      result.push_back(*model);
  return result;
}

std::optional<std::size_t> place_among(const std::vector<Model> &models, const Model &model)
{
  for (std::size_t m = 0; m < models.size(); ++m)
    if (models[m].effects == model.effects)
      return m;
  return {};
}

/// Shares the probability of refuted models among the rest, and chooses the answer anew. If they
/// were all of the answer, "none of these" is in the new one, and is all of it if nothing else is
/// left or as likely.
void withdraw(const std::vector<Model> &refuted, const TestedModels &tested,
              const DecisionRule &rule, Findings &findings)
{
  std::vector<Model> &models = findings.models;
  const auto is_refuted = [&](const Model &model) {
    return !model.is_discrepancy && is_among(model, refuted);
  };
  const auto likeliest = std::find_if(models.begin(), models.end(), [&](const Model &model) {
    return !model.is_discrepancy && !is_refuted(model);
  });
  // Data of something else would often have refuted it, too.
  if (likeliest != models.end())
    if (const auto place = place_among(tested.models, *likeliest)) {
      for (Model &model : models)
        model.probability *= model.is_discrepancy ? tested.passes[*place] : 1.;
      findings.off_catalogue *= tested.passes[*place];
    }
  double left = 0.;
  for (const Model &model : models)
    left += is_refuted(model) ? 0. : model.probability;
  if (left == 0.) {
    findings.verdict = Verdict::off_catalogue;
    return;
  }
  // What the answer did not have is unlikely, so that it may as well be none of the catalogue.
  const bool is_all_refuted = is_all_among(findings.answer, refuted);
  for (Model &model : models)
    model.probability = is_refuted(model) ? 0. : model.probability / left;
  sort_by_probability(models);
  findings.off_catalogue /= left;
  choose(rule, findings);
  findings.none_of_these |= is_all_refuted;
  findings.verdict = models.front().is_discrepancy ? Verdict::off_catalogue : verdict_of(findings);
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

} // namespace

std::optional<std::size_t> refute(const TestedModels &tested, const Untested untested,
                                  const DecisionRule &rule,
                                  const std::function<void(Findings &)> &judge, Findings &findings)
{
  constexpr std::size_t leader_of_fit = 0;
  if (findings.verdict != Verdict::named && findings.verdict != Verdict::tie)
    return tested.models.empty() ? std::nullopt : std::make_optional(leader_of_fit);

  std::vector<Model> refuted;
  for (std::size_t m = 0; m < tested.models.size(); ++m)
    if (tested.p[m] < rule.refuted)
      refuted.push_back(tested.models[m]);
  const std::vector<Model> by_fit = findings.answer;
  // A new answer is made of models that were tested: what leads the rest is likely only beside
  // others as unlikely.
  const bool is_all_refuted = is_all_among(by_fit, refuted);
  if (untested == Untested::fall || is_all_refuted)
    for (const Model &model : falling_with(refuted, tested.models, findings.models))
      refuted.push_back(model);
  withdraw(refuted, tested, rule, findings);
  if (untested == Untested::fall && is_all_refuted)
    keep_tested(tested.models, findings);
  if (findings.verdict == Verdict::off_catalogue) {
    findings.answer = by_fit;
    return leader_of_fit;
  }

  const std::optional<std::size_t> leader = place_among(tested.models, findings.answer.front());
  if (leader == leader_of_fit)
    findings.none_of_these |= findings.p_fit < rule.doubtful;
  else
    judge(findings);
  if (findings.verdict != Verdict::off_catalogue) {
    findings.none_of_these |= !leader || tested.p[*leader] < rule.doubtful;
    findings.verdict = verdict_of(findings);
  }
  return leader;
}

} // namespace eunoe::discovery
