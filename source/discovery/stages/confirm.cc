#include <eunoe/discovery/stages/design.h>
#include <eunoe/discovery/stages/stages.h>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

Table describe_models(const StudyState &study, const std::vector<ScoredModel> &models)
{
  constexpr double least = 1e-3;
  Table rows = Table::array();
  for (const ScoredModel &model : models) {
    if (model.probability < least && !rows.empty())
      continue;
    Table amplitudes = Table::object();
    for (const auto &[name, value] : study.amplitudes(model.fit.effects, model.fit.position))
      amplitudes[name] = value;
    rows.push_back({{"effects", name_of(study, model.fit.effects)},
                    {"probability", model.probability},
                    {"amplitudes", amplitudes},
                    {"distance", model.fit.distance},
                    {"leverage", model.fit.leverage}});
  }
  return rows;
}

std::vector<ScoredModel> promising_models(const StudyState &study, const Posterior &posterior,
                                          const DecisionRule &decision)
{
  std::vector<ScoredModel> models = posterior.models;
  for (ScoredModel &model : models)
    model.score +=
        (study.misfit.deviance(optimistic_distance(study, model.fit), 0.) - model.fit.deviance) /
        decision.temperature;
  std::stable_sort(models.begin(), models.end(),
                   [](const ScoredModel &a, const ScoredModel &b) { return a.score < b.score; });
  double sum = 0.;
  for (ScoredModel &model : models)
    sum += model.probability = std::exp(-0.5 * (model.score - models.front().score));
  for (ScoredModel &model : models)
    model.probability /= sum;
  return models;
}

namespace {

struct LeadingEffect
{
  std::size_t effect;
  Amplitudes amplitudes;
};

/// Whether a set is more promising with one of its effects than without it. If it is not, the
/// effect is in the set by chance with a tiny amplitude, and runs there would tell nothing about
/// the effect.
bool is_needed(const std::vector<ScoredModel> &models, const ScoredModel &model,
               const std::size_t effect)
{
  EffectSet without;
  for (const std::size_t k : model.fit.effects)
    if (k != effect)
      without.push_back(k);
  return std::none_of(models.begin(), models.end(), [&](const ScoredModel &other) {
    return other.fit.effects == without && other.score <= model.score;
  });
}

/// The most promising effects, each at its amplitude in the most promising set that needs it.
std::vector<LeadingEffect> leading_effects(const StudyState &study, const Posterior &posterior,
                                           const DecisionRule &decision)
{
  const std::vector<ScoredModel> models = promising_models(study, posterior, decision);
  std::vector<double> inclusion(study.effects.size(), 0.);
  for (const ScoredModel &model : models)
    for (const std::size_t k : model.fit.effects)
      inclusion[k] += model.probability;
  std::vector<std::size_t> order(study.effects.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    order[k] = k;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return inclusion[a] > inclusion[b]; });
  std::vector<LeadingEffect> result;
  for (const std::size_t k : order) {
    const bool likely = inclusion[k] >= decision.least_inclusion;
    if (result.size() >= study.options.n_leaders || (!likely && result.size() >= 2))
      break;
    for (const ScoredModel &model : models) {
      const EffectSet &set = model.fit.effects;
      const auto place = std::find(set.begin(), set.end(), k);
      if (place == set.end() || !is_needed(models, model, k))
        continue;
      const Eigen::VectorXd position =
          Eigen::VectorXd::Constant(1, model.fit.position(place - set.begin()));
      if (position(0) != 0.)
        result.push_back({k, nearest_design_point(study, {k}, position)});
      break;
    }
  }
  return result;
}

/// Whether further runs would change nothing: one set of effects is almost certain, and there are
/// runs at its amplitudes.
bool is_conclusive(const StudyState &study, const Posterior &posterior)
{
  constexpr double sure = 0.99;
  constexpr unsigned int enough = 6;
  const ScoredModel &best = posterior.best();
  if (best.probability < sure)
    return false;
  for (std::size_t k = 0; k < best.fit.effects.size(); ++k) {
    const Eigen::VectorXd position =
        Eigen::VectorXd::Constant(1, best.fit.position(static_cast<Eigen::Index>(k)));
    const auto there =
        study.replicates.find(nearest_design_point(study, {best.fit.effects[k]}, position));
    if (there == study.replicates.end() || there->second.size() < enough)
      return false;
  }
  return true;
}

} // namespace

Table stage_confirm(StudyState &study, Findings &findings)
{
  Table rounds = Table::array();
  findings.posterior = compare_models(study, findings.decision);
  rounds.push_back({{"confirmed", Table::array()},
                    {"models", describe_models(study, findings.posterior.models)},
                    {"off catalogue", findings.posterior.off_catalogue}});
  const unsigned int most = study.options.confirm ? study.options.confirm_rounds : 0;
  for (unsigned int round = 0; round < most && !is_conclusive(study, findings.posterior); ++round) {
    std::vector<DesignPoint> design;
    Table names = Table::array();
    for (const LeadingEffect &leading :
         leading_effects(study, findings.posterior, findings.decision)) {
      const auto there = static_cast<unsigned int>(study.replicates[leading.amplitudes].size());
      design.push_back({leading.amplitudes, there + study.options.confirm_runs});
      names.push_back({{"effect", study.effects[leading.effect].name},
                       {"amplitude", leading.amplitudes.begin()->second}});
    }
    study.run_design(design);
    estimate_replicate_covariance(study);
    findings.posterior = compare_models(study, findings.decision);
    rounds.push_back({{"confirmed", names},
                      {"models", describe_models(study, findings.posterior.models)},
                      {"off catalogue", findings.posterior.off_catalogue}});
  }
  return {{"rounds", rounds}};
}

} // namespace eunoe::discovery
