#include <eunoe/discovery/stages/places.h>
#include <eunoe/discovery/stages/stages.h>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

Table describe_models(const Workbench &bench, const std::vector<Scored> &models)
{
  constexpr double least = 1e-3;
  Table rows = Table::array();
  for (const Scored &model : models) {
    if (model.probability < least && !rows.empty())
      continue;
    Table amplitudes = Table::object();
    for (const auto &[name, value] : bench.amplitudes(model.fit.effects, model.fit.position))
      amplitudes[name] = value;
    rows.push_back({{"effects", name_of(bench, model.fit.effects)},
                    {"probability", model.probability},
                    {"amplitudes", amplitudes},
                    {"distance", model.fit.distance},
                    {"leverage", model.fit.leverage}});
  }
  return rows;
}

std::vector<Scored> promising(const Workbench &bench, const Posterior &posterior,
                              const Decision &decision)
{
  std::vector<Scored> models = posterior.models;
  for (Scored &model : models)
    model.score +=
        (bench.misfit.deviance(hoped_distance(bench, model.fit), 0.) - model.fit.deviance) /
        decision.temperature;
  std::stable_sort(models.begin(), models.end(),
                   [](const Scored &a, const Scored &b) { return a.score < b.score; });
  double sum = 0.;
  for (Scored &model : models)
    sum += model.probability = std::exp(-0.5 * (model.score - models.front().score));
  for (Scored &model : models)
    model.probability /= sum;
  return models;
}

namespace {

struct Leader
{
  std::size_t effect;
  Amplitudes amplitudes;
};

/// Whether a set is more promising than it is without one of its effects. Otherwise that effect is
/// in it by chance, with a sliver of an amplitude, and runs there would say nothing of the effect.
bool wants(const std::vector<Scored> &models, const Scored &model, const std::size_t effect)
{
  EffectSet without;
  for (const std::size_t k : model.fit.effects)
    if (k != effect)
      without.push_back(k);
  return std::none_of(models.begin(), models.end(), [&](const Scored &other) {
    return other.fit.effects == without && other.score <= model.score;
  });
}

/// The most promising effects, each at its amplitude in the most promising set that wants it.
std::vector<Leader> leaders(const Workbench &bench, const Posterior &posterior,
                            const Decision &decision)
{
  const std::vector<Scored> models = promising(bench, posterior, decision);
  std::vector<double> inclusion(bench.effects.size(), 0.);
  for (const Scored &model : models)
    for (const std::size_t k : model.fit.effects)
      inclusion[k] += model.probability;
  std::vector<std::size_t> order(bench.effects.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    order[k] = k;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return inclusion[a] > inclusion[b]; });
  std::vector<Leader> result;
  for (const std::size_t k : order) {
    const bool likely = inclusion[k] >= decision.least_inclusion;
    if (result.size() >= bench.options.n_leaders || (!likely && result.size() >= 2))
      break;
    for (const Scored &model : models) {
      const EffectSet &set = model.fit.effects;
      const auto place = std::find(set.begin(), set.end(), k);
      if (place == set.end() || !wants(models, model, k))
        continue;
      const Eigen::VectorXd position =
          Eigen::VectorXd::Constant(1, model.fit.position(place - set.begin()));
      if (position(0) != 0.)
        result.push_back({k, near_amplitudes(bench, {k}, position)});
      break;
    }
  }
  return result;
}

/// Whether further runs would change nothing: one set of effects stands out, and there are runs
/// where it says.
bool is_settled(const Workbench &bench, const Posterior &posterior)
{
  constexpr double sure = 0.99;
  constexpr unsigned int enough = 6;
  const Scored &best = posterior.best();
  if (best.probability < sure)
    return false;
  for (std::size_t k = 0; k < best.fit.effects.size(); ++k) {
    const Eigen::VectorXd position =
        Eigen::VectorXd::Constant(1, best.fit.position(static_cast<Eigen::Index>(k)));
    const auto there = bench.runs.find(near_amplitudes(bench, {best.fit.effects[k]}, position));
    if (there == bench.runs.end() || there->second.size() < enough)
      return false;
  }
  return true;
}

} // namespace

Table stage_confirm(Workbench &bench, Findings &findings)
{
  Table rounds = Table::array();
  findings.posterior = compare_models(bench, findings.decision);
  rounds.push_back({{"confirmed", Table::array()},
                    {"models", describe_models(bench, findings.posterior.models)},
                    {"off catalogue", findings.posterior.off_catalogue}});
  const unsigned int most = bench.options.confirm ? bench.options.confirm_rounds : 0;
  for (unsigned int round = 0; round < most && !is_settled(bench, findings.posterior); ++round) {
    std::vector<Workbench::Order> orders;
    Table names = Table::array();
    for (const Leader &leader : leaders(bench, findings.posterior, findings.decision)) {
      const auto there = static_cast<unsigned int>(bench.runs[leader.amplitudes].size());
      orders.push_back({leader.amplitudes, there + bench.options.confirm_runs});
      names.push_back({{"effect", bench.effects[leader.effect].name},
                       {"amplitude", leader.amplitudes.begin()->second}});
    }
    bench.ask(orders);
    settle_chaos(bench);
    findings.posterior = compare_models(bench, findings.decision);
    rounds.push_back({{"confirmed", names},
                      {"models", describe_models(bench, findings.posterior.models)},
                      {"off catalogue", findings.posterior.off_catalogue}});
  }
  return {{"rounds", rounds}};
}

} // namespace eunoe::discovery
