#include <eunoe/discovery/stages/stages.h>
#include <eunoe/discovery/stages/verification.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace eunoe::discovery {

double p_of_fit(const Findings &findings, const Fit &fit)
{
  const double modes = findings.null_distribution.n_modes;
  return findings.null_distribution.p_distance(
      fit.distance, std::max(1., modes - static_cast<double>(fit.effects.size())) / modes);
}

namespace {

/// Finds a set among those that were compared. If it is not there, the likeliest: triples are
/// compared only if they contain one of the best pairs, and more runs may have changed these.
const ScoredModel &find_scored(const std::vector<ScoredModel> &models, const EffectSet &set)
{
  const auto found = std::find_if(models.begin(), models.end(), [&](const ScoredModel &model) {
    return model.fit.effects == set;
  });
  return found != models.end() ? *found : models.front();
}

/// Backward elimination: removes effects one after the other, as long as the deviance rises by less
/// than chance explains; the effect with the smallest rise first.
ScoredModel eliminate_effects(const StudyState &study, const Findings &findings,
                              const ScoredModel &model, Table &steps)
{
  const double limit = findings.null_distribution.gain_limit(study.options.level);
  ScoredModel result = model;
  while (result.fit.effects.size() > 1) {
    double least = limit;
    EffectSet best;
    for (const std::size_t k : result.fit.effects) {
      EffectSet without;
      for (const std::size_t l : result.fit.effects)
        if (l != k)
          without.push_back(l);
      const double loss = fit_model(study, without).deviance - result.fit.deviance;
      steps.push_back({{"without", study.effects[k].name},
                       {"of", name_of(study, result.fit.effects)},
                       {"loss", loss},
                       {"loss needed", limit},
                       {"p", findings.null_distribution.p_gain(loss)}});
      if (loss < least) {
        least = loss;
        best = without;
      }
    }
    if (best.empty())
      break;
    result = find_scored(findings.posterior.models, best);
  }
  return result;
}

/// Forward selection: if the fit refutes the model, and the best larger set that contains it lowers
/// the deviance by more than chance explains, takes that set. A refuted model is not preferred for
/// being simple.
ScoredModel add_effect(const StudyState &study, const Findings &findings, const ScoredModel &model,
                       Table &steps)
{
  const EffectSet &set = model.fit.effects;
  if (set.empty() || set.size() >= study.options.max_effects ||
      p_of_fit(findings, model.fit) > study.options.level)
    return model;
  const auto holds = [&](const ScoredModel &other) {
    return other.fit.effects.size() == set.size() + 1 &&
           std::includes(other.fit.effects.begin(), other.fit.effects.end(), set.begin(),
                         set.end());
  };
  const auto &models = findings.posterior.models;
  const auto larger = std::find_if(models.begin(), models.end(), holds);
  if (larger == models.end())
    return model;
  const double gain = model.fit.deviance - larger->fit.deviance;
  const double limit = findings.null_distribution.gain_limit(study.options.level);
  steps.push_back({{"added to", name_of(study, set)},
                   {"makes", name_of(study, larger->fit.effects)},
                   {"gain", gain},
                   {"gain needed", limit},
                   {"p of the fit before", p_of_fit(findings, model.fit)},
                   {"p of the fit", p_of_fit(findings, larger->fit)}});
  return gain > limit ? *larger : model;
}

/// Runs more replicates of those competing sets of effects whose emulators rest on much fewer runs
/// than the best known one. Otherwise the comparison is biased: each run lowers the variance of a
/// set's prediction, so that sets with more runs look likelier.
/// @returns a row for each; empty if all have similar leverage
Table replicate_competitors(StudyState &study, const Findings &findings)
{
  constexpr double within_reach = 0.02, much_less_known = 1.25;
  constexpr std::size_t most = 3;
  const EffectSet &chosen = findings.chosen.fit.effects;
  std::vector<ScoredModel> models = promising_models(study, findings.posterior, findings.decision);
  const double probability = find_scored(models, chosen).probability;
  models.erase(std::remove_if(models.begin(), models.end(),
                              [&](const ScoredModel &model) {
                                return model.fit.effects.size() != chosen.size() ||
                                       model.probability < within_reach * probability;
                              }),
               models.end());
  double least = std::numeric_limits<double>::infinity();
  for (const ScoredModel &model : models)
    least = std::min(least, model.fit.leverage);
  std::vector<Fit> less_known;
  for (const ScoredModel &model : models)
    if (less_known.size() < most && model.fit.leverage > much_less_known * least)
      less_known.push_back(model.fit);
  return verify(study, less_known, study.options.fit_runs);
}

} // namespace

Table stage_fit(StudyState &study, Findings &findings)
{
  Table passes = Table::array();
  Table steps = Table::array();
  constexpr unsigned int least_passes = 2, most_passes = 6;
  for (unsigned int pass = 0; pass < most_passes; ++pass) {
    findings.chosen = eliminate_effects(study, findings, findings.posterior.best(), steps);
    if (pass >= least_passes && is_verified(study, findings.chosen.fit))
      break;
    passes.push_back(
        verify(study, {findings.chosen.fit}, (study.options.fit_runs + 1 - pass % 2) / 2).front());
    estimate_replicate_covariance(study);
    findings.posterior = compare_models(study, findings.decision);
  }
  return {{"passes", passes},
          {"deletions tried", steps},
          {"models", describe_models(study, findings.posterior.models)}};
}

Table stage_iterate(StudyState &study, Findings &findings)
{
  Table rounds = Table::array();
  constexpr int most = 6, most_challenges = 3;
  int challenges = 0;
  for (int round = 0; round < most; ++round) {
    Table steps = Table::array();
    const EffectSet before = findings.chosen.fit.effects;
    Table additions = Table::array();
    findings.chosen =
        add_effect(study, findings,
                   eliminate_effects(study, findings, findings.posterior.best(), steps), additions);
    Table row = {{"effects", name_of(study, findings.chosen.fit.effects)},
                 {"likeliest", name_of(study, findings.posterior.best().fit.effects)},
                 {"deletions tried", steps},
                 {"additions tried", additions}};
    const bool settled = findings.chosen.fit.effects == before;
    if (!settled)
      row["verification"] = verify(study, {findings.chosen.fit}, study.options.fit_runs).front();
    else if (study.options.confirm && challenges++ < most_challenges)
      row["rivals"] = replicate_competitors(study, findings);
    rounds.push_back(row);
    if (settled && row.value("rivals", Table::array()).empty())
      break;
    estimate_replicate_covariance(study);
    findings.posterior = compare_models(study, findings.decision);
  }
  findings.chosen = find_scored(findings.posterior.models, findings.chosen.fit.effects);
  findings.p_fit = p_of_fit(findings, findings.chosen.fit);
  return {{"rounds", rounds},
          {"p of the fit", findings.p_fit},
          {"models", describe_models(study, findings.posterior.models)}};
}

Interval amplitude_interval(const StudyState &study, const Findings &findings, const Fit &fit,
                            const std::size_t member)
{
  return profile_interval(study, fit, member,
                          findings.decision.width_of_intervals *
                              findings.null_distribution.direction_limit);
}

Table describe_amplitudes(const StudyState &study, const Findings &findings)
{
  Table rows = Table::array();
  const Fit &fit = findings.chosen.fit;
  for (std::size_t k = 0; k < fit.effects.size(); ++k) {
    const Factor &effect = study.effects[fit.effects[k]];
    const Interval interval = amplitude_interval(study, findings, fit, k);
    const auto amplitude = [&](double u) { return effect.null_value + u * effect.scale; };
    rows.push_back({{"effect", effect.name},
                    {"unit", effect.unit},
                    {"amplitude", amplitude(fit.position(static_cast<Eigen::Index>(k)))},
                    {"lower", amplitude(interval.lower)},
                    {"upper", amplitude(interval.upper)},
                    {"lower reached", !interval.open_below},
                    {"upper reached", !interval.open_above},
                    {"confidence", findings.confidence[fit.effects[k]]}});
  }
  return rows;
}

Eigen::VectorXd nuisance_estimates(const StudyState &study, const Eigen::VectorXd &remainder,
                                   const double leverage)
{
  const Eigen::MatrixXd changes =
      study.misfit.coordinates(study.modes.basis() * study.nuisance_changes);
  return changes.transpose() * remainder.cwiseQuotient(study.misfit.variance(leverage));
}

Eigen::MatrixXd nuisance_covariance(const StudyState &study, const double leverage)
{
  const Eigen::MatrixXd changes =
      study.misfit.coordinates(study.modes.basis() * study.nuisance_changes);
  const Eigen::VectorXd weight = study.misfit.variance(leverage).cwiseInverse();
  return Eigen::MatrixXd::Identity(changes.cols(), changes.cols()) -
         changes.transpose() * weight.asDiagonal() * changes;
}

} // namespace eunoe::discovery
