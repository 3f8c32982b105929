#include <eunoe/discovery/stages/stages.h>
#include <eunoe/discovery/stages/verification.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace eunoe::discovery {

double p_of_fit(const Findings &findings, const Fit &fit)
{
  const double modes = findings.reference.n_modes;
  return findings.reference.p_distance(
      fit.distance, std::max(1., modes - static_cast<double>(fit.effects.size())) / modes);
}

namespace {

/// A set among those that were compared; the likeliest where it is none of them, as triples are
/// only compared about the best pairs, which more runs may have changed.
const Scored &find_scored(const std::vector<Scored> &models, const EffectSet &set)
{
  const auto found = std::find_if(models.begin(), models.end(),
                                  [&](const Scored &model) { return model.fit.effects == set; });
  return found != models.end() ? *found : models.front();
}

/// Takes effects away whose removal the data do not resent, the least needed first.
Scored prune(const Workbench &bench, const Findings &findings, const Scored &model, Table &steps)
{
  const double limit = findings.reference.gain_limit(bench.options.level);
  Scored result = model;
  while (result.fit.effects.size() > 1) {
    double least = limit;
    EffectSet best;
    for (const std::size_t k : result.fit.effects) {
      EffectSet without;
      for (const std::size_t l : result.fit.effects)
        if (l != k)
          without.push_back(l);
      const double loss = fit_model(bench, without).deviance - result.fit.deviance;
      steps.push_back({{"without", bench.effects[k].name},
                       {"of", name_of(bench, result.fit.effects)},
                       {"loss", loss},
                       {"loss needed", limit},
                       {"p", findings.reference.p_gain(loss)}});
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

/// Adds an effect to a model that does not describe the data, if the best larger set that holds it
/// describes them better by more than chance does. A model that is refuted is no alternative,
/// however simple it is.
Scored enlarge(const Workbench &bench, const Findings &findings, const Scored &model, Table &steps)
{
  const EffectSet &set = model.fit.effects;
  if (set.empty() || set.size() >= bench.options.max_effects ||
      p_of_fit(findings, model.fit) > bench.options.level)
    return model;
  const auto holds = [&](const Scored &other) {
    return other.fit.effects.size() == set.size() + 1 &&
           std::includes(other.fit.effects.begin(), other.fit.effects.end(), set.begin(),
                         set.end());
  };
  const auto &models = findings.posterior.models;
  const auto larger = std::find_if(models.begin(), models.end(), holds);
  if (larger == models.end())
    return model;
  const double gain = model.fit.deviance - larger->fit.deviance;
  const double limit = findings.reference.gain_limit(bench.options.level);
  steps.push_back({{"added to", name_of(bench, set)},
                   {"makes", name_of(bench, larger->fit.effects)},
                   {"gain", gain},
                   {"gain needed", limit},
                   {"p of the fit before", p_of_fit(findings, model.fit)},
                   {"p of the fit", p_of_fit(findings, larger->fit)}});
  return gain > limit ? *larger : model;
}

/// Makes runs of the chosen set and its rivals, as far as some could be as likely as others were
/// they known as well. Nothing else is fair: runs take from a set's doubt, and a set that got more
/// of them looks likelier.
/// @returns a row for each; none if all are known alike
Table challenge(Workbench &bench, const Findings &findings)
{
  constexpr double within_reach = 0.02, much_less_known = 1.25;
  constexpr std::size_t most = 3;
  const EffectSet &chosen = findings.chosen.fit.effects;
  std::vector<Scored> models = promising(bench, findings.posterior, findings.decision);
  const double probability = find_scored(models, chosen).probability;
  models.erase(std::remove_if(models.begin(), models.end(),
                              [&](const Scored &model) {
                                return model.fit.effects.size() != chosen.size() ||
                                       model.probability < within_reach * probability;
                              }),
               models.end());
  double least = std::numeric_limits<double>::infinity();
  for (const Scored &model : models)
    least = std::min(least, model.fit.leverage);
  std::vector<Fit> less_known;
  for (const Scored &model : models)
    if (less_known.size() < most && model.fit.leverage > much_less_known * least)
      less_known.push_back(model.fit);
  return verify(bench, less_known, bench.options.fit_runs);
}

} // namespace

Table stage_fit(Workbench &bench, Findings &findings)
{
  Table passes = Table::array();
  Table steps = Table::array();
  constexpr unsigned int least_passes = 2, most_passes = 6;
  for (unsigned int pass = 0; pass < most_passes; ++pass) {
    findings.chosen = prune(bench, findings, findings.posterior.best(), steps);
    if (pass >= least_passes && is_verified(bench, findings.chosen.fit))
      break;
    passes.push_back(
        verify(bench, {findings.chosen.fit}, (bench.options.fit_runs + 1 - pass % 2) / 2).front());
    settle_chaos(bench);
    findings.posterior = compare_models(bench, findings.decision);
  }
  return {{"passes", passes},
          {"deletions tried", steps},
          {"models", describe_models(bench, findings.posterior.models)}};
}

Table stage_iterate(Workbench &bench, Findings &findings)
{
  Table rounds = Table::array();
  constexpr int most = 6, most_challenges = 3;
  int challenges = 0;
  for (int round = 0; round < most; ++round) {
    Table steps = Table::array();
    const EffectSet before = findings.chosen.fit.effects;
    Table additions = Table::array();
    findings.chosen = enlarge(bench, findings,
                              prune(bench, findings, findings.posterior.best(), steps), additions);
    Table row = {{"effects", name_of(bench, findings.chosen.fit.effects)},
                 {"likeliest", name_of(bench, findings.posterior.best().fit.effects)},
                 {"deletions tried", steps},
                 {"additions tried", additions}};
    const bool settled = findings.chosen.fit.effects == before;
    if (!settled)
      row["verification"] = verify(bench, {findings.chosen.fit}, bench.options.fit_runs).front();
    else if (bench.options.confirm && challenges++ < most_challenges)
      row["rivals"] = challenge(bench, findings);
    rounds.push_back(row);
    if (settled && row.value("rivals", Table::array()).empty())
      break;
    settle_chaos(bench);
    findings.posterior = compare_models(bench, findings.decision);
  }
  findings.chosen = find_scored(findings.posterior.models, findings.chosen.fit.effects);
  findings.p_fit = p_of_fit(findings, findings.chosen.fit);
  return {{"rounds", rounds},
          {"p of the fit", findings.p_fit},
          {"models", describe_models(bench, findings.posterior.models)}};
}

Interval amplitude_interval(const Workbench &bench, const Findings &findings, const Fit &fit,
                            const std::size_t member)
{
  return profile_interval(bench, fit, member,
                          findings.decision.width_of_intervals *
                              findings.reference.direction_limit);
}

Table describe_amplitudes(const Workbench &bench, const Findings &findings)
{
  Table rows = Table::array();
  const Fit &fit = findings.chosen.fit;
  for (std::size_t k = 0; k < fit.effects.size(); ++k) {
    const Factor &effect = bench.effects[fit.effects[k]];
    const Interval interval = amplitude_interval(bench, findings, fit, k);
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

Eigen::VectorXd nuisance_estimates(const Workbench &bench, const Eigen::VectorXd &remainder,
                                   const double leverage)
{
  const Eigen::MatrixXd changes =
      bench.misfit.coordinates(bench.modes.basis() * bench.nuisance_cells);
  return changes.transpose() * remainder.cwiseQuotient(bench.misfit.variance(leverage));
}

Eigen::MatrixXd nuisance_covariance(const Workbench &bench, const double leverage)
{
  const Eigen::MatrixXd changes =
      bench.misfit.coordinates(bench.modes.basis() * bench.nuisance_cells);
  const Eigen::VectorXd weight = bench.misfit.variance(leverage).cwiseInverse();
  return Eigen::MatrixXd::Identity(changes.cols(), changes.cols()) -
         changes.transpose() * weight.asDiagonal() * changes;
}

} // namespace eunoe::discovery
