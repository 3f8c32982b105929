#include <eunoe/discovery/inference/decision.h>
#include <eunoe/discovery/inference/predictive.h>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

namespace {

/// "None of the catalogue" gets what effects that look like those of the catalogue give it.
void allow_for_relatives(const Evidence &evidence, const DecisionRule &rule,
                         const std::uint32_t seed, Findings &findings)
{
  std::vector<Model> &models = findings.models;
  const auto likeliest = std::find_if(models.begin(), models.end(),
                                      [](const Model &m) { return m.effects.size() == 1; });
  if (likeliest == models.end())
    return;
  const auto &[effect, amplitude] = *likeliest->best.begin();
  findings.lookalikes = find_lookalikes(evidence, evidence.place_near(effect, amplitude).strength,
                                        findings.threshold, rule.twins, seed);
  const double log_evidence =
      findings.lookalikes.log_evidence(models, findings.calibration.temperature);
  for (Model &model : models)
    if (model.is_discrepancy)
      model.log_evidence = log_evidence;
}

/// Whether a model is one of the answer with another effect that it hardly needs, as it has not
/// made it likelier.
bool is_needless(const Model &model, const std::vector<Model> &answer)
{
  return std::any_of(answer.begin(), answer.end(),
                     [&](const Model &likelier) { return is_part(likelier, model); });
}

/// Log of prior and evidence that a model of one or two effects could have, for a single effect all
/// its amplitudes together.
double log_hope(const Evidence &evidence, const Model &model)
{
  return model.effects.size() == 1
             ? log_sum(evidence.optimistic(model.effects.front(), tuned::ending::luck))
             : evidence.optimistic_pair(model);
}

} // namespace

std::string name_of(const Verdict verdict)
{
  constexpr const char *names[] = {"none", "named", "tie", "off catalogue", "underpowered"};
  return names[static_cast<int>(verdict)];
}

int exit_code(const Verdict verdict)
{
  constexpr int first = 10;
  return verdict == Verdict::none ? 0 : first + static_cast<int>(verdict) - 1;
}

double probability_of(const std::vector<Model> &models, const std::size_t effect)
{
  double sum = 0.;
  for (const Model &model : models)
    if (std::find(model.effects.begin(), model.effects.end(), effect) != model.effects.end())
      sum += model.probability;
  return sum;
}

Findings weigh(const Evidence &evidence, const StudyOptions &options, const DecisionRule &rule)
{
  Findings findings;
  const Eigen::VectorXd &data = evidence.target().data();
  const Tail null = null_distribution(evidence, rule.null_draws, options.seed);
  findings.log_bayes_factor = evidence.log_bayes_factors(data)(0);
  findings.p_nothing = null.p(findings.log_bayes_factor);
  findings.detected = findings.p_nothing <= options.level;
  findings.threshold = null.quantile(options.level);
  findings.calibration = calibrate(evidence, findings.threshold, rule.twins, options.seed);
  findings.models = evidence.models(data);
  if (findings.detected)
    allow_for_relatives(evidence, rule, options.seed, findings);
  temper(findings.models, findings.calibration.temperature);
  for (const Model &model : findings.models)
    if (model.is_discrepancy)
      findings.off_catalogue = model.probability;
  return findings;
}

Verdict verdict_of(const Findings &findings)
{
  if (findings.answer.empty())
    return Verdict::off_catalogue;
  return findings.answer.size() == 1 && !findings.none_of_these ? Verdict::named : Verdict::tie;
}

void choose(const DecisionRule &rule, Findings &findings)
{
  findings.answer.clear();
  findings.none_of_these = false;
  double sum = 0.;
  for (const Model &model : findings.models) {
    if (sum >= rule.credible)
      break;
    sum += model.probability;
    if (model.is_discrepancy)
      findings.none_of_these = model.probability > 1. - rule.credible;
    else if (!is_needless(model, findings.answer))
      findings.answer.push_back(model);
  }
}

void allow_for_untried(const std::size_t untried, const std::size_t effects, Findings &findings)
{
  if (untried > 0 && findings.verdict == Verdict::named) {
    findings.none_of_these = true;
    findings.verdict = verdict_of(findings);
  }
  if (2 * untried > effects && findings.verdict == Verdict::off_catalogue) {
    findings.answer.clear();
    findings.verdict = Verdict::underpowered;
  }
}

const Model *closest_model(const Findings &findings)
{
  if (!findings.answer.empty())
    return &findings.answer.front();
  const auto found = std::find_if(findings.models.begin(), findings.models.end(),
                                  [](const Model &model) { return !model.is_discrepancy; });
  return found == findings.models.end() ? nullptr : &*found;
}

void judge(const Evidence &evidence, const DecisionRule &rule, const std::uint32_t seed,
           Findings &findings)
{
  findings.verdict =
      findings.models.front().is_discrepancy ? Verdict::off_catalogue : verdict_of(findings);
  const Model *const closest = closest_model(findings);
  if (closest == nullptr)
    return;
  findings.p_fit =
      p_of_fit(evidence, *closest, draw_posterior(evidence, *closest, rule.predictive_draws, seed),
               seed + 2);
  if (findings.answer.empty())
    return;
  findings.none_of_these |= findings.p_fit < rule.doubtful;
  // Nothing of the catalogue describes the data if not even the likeliest model does.
  if (findings.p_fit < rule.refuted)
    findings.verdict = Verdict::off_catalogue;
  else if (findings.verdict != Verdict::off_catalogue)
    findings.verdict = verdict_of(findings);
}

bool has_challenger(const Evidence &evidence, const Findings &findings)
{
  const double temperature = findings.calibration.temperature;
  const Model &first = findings.models.front();
  // With which probability a model would stand beside the others as they are now. (A model outside
  // of a tie of several may have a twentieth of the first one's for ever.)
  const auto hoped = [&](const Model &model) {
    const double log_evidence = log_hope(evidence, model) - model.log_prior;
    return first.probability * std::exp(model.log_prior - first.log_prior +
                                        (log_evidence - first.log_evidence) / temperature);
  };
  return std::any_of(findings.models.begin(), findings.models.end(), [&](const Model &model) {
    if (model.is_discrepancy)
      return false;
    double needed = tuned::ending::challenger;
    for (const Model &member : findings.answer) {
      if (is_part(model, member))
        return false;
      if (is_part(member, model))
        needed = std::max(needed, member.probability);
    }
    return hoped(model) > needed;
  });
}

bool could_be_detected(const Evidence &evidence, const Findings &findings)
{
  const double needed = findings.threshold + evidence.log_nothing(evidence.target().data())(0);
  return std::any_of(findings.models.begin(), findings.models.end(), [&](const Model &model) {
    return model.effects.size() == 1 && log_hope(evidence, model) > needed;
  });
}

} // namespace eunoe::discovery
