#include <eunoe/discovery/stages/posterior.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace eunoe::discovery {

namespace {

double choose(const double n, const std::size_t k)
{
  double result = 1.;
  for (std::size_t i = 0; i < k; ++i)
    result *= (n - static_cast<double>(i)) / static_cast<double>(i + 1);
  return std::max(1., result);
}

Scored score(const Workbench &bench, const Decision &decision, const EffectSet &set,
             const double n_effects)
{
  Scored scored;
  scored.fit = fit_model(bench, set);
  const std::size_t size = set.size();
  scored.score = scored.fit.deviance / decision.temperature +
                 decision.cost_of_effect * static_cast<double>(size) -
                 2. * std::log(decision.prior_of_size[size - 1] / choose(n_effects, size));
  return scored;
}

/// -2 log evidence of something else: a change of any size along directions like those of the
/// catalogue's fingerprints, or along none in particular.
double score_off_catalogue(const Workbench &bench, const Decision &decision,
                           const std::vector<std::size_t> &simulated)
{
  constexpr double share_of_fingerprints = 0.7;
  const Eigen::Index n = bench.misfit.size();
  Eigen::MatrixXd directions = Eigen::MatrixXd::Identity(n, n) *
                               ((1. - share_of_fingerprints) / static_cast<double>(n));
  for (const std::size_t k : simulated) {
    const Response response = bench.response({k});
    const Bounds range = bounds(bench, {k}, response);
    Eigen::VectorXd change =
        response.change(range.upper(0) > -range.lower(0) ? range.upper : range.lower);
    if (change.norm() > 0.)
      change.normalize();
    directions += change * change.transpose() * share_of_fingerprints /
                  static_cast<double>(simulated.size());
  }
  const Fit base = fit_model(bench, {});
  const Eigen::VectorXd deviation = bench.misfit.variance(base.leverage).cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(
      deviation.asDiagonal() * directions * deviation.asDiagonal());
  const Eigen::ArrayXd square =
      (eigen.eigenvectors().transpose() * deviation.cwiseProduct(base.remainder))
          .array()
          .square();
  const double determinant = bench.misfit.log_determinant(base.leverage);

  std::vector<double> deviances;
  for (double strength = 1.; strength < 130.; strength *= std::sqrt(2.)) {
    const Eigen::ArrayXd variance =
        1. + strength * strength * eigen.eigenvalues().array().max(0.);
    deviances.push_back(bench.misfit.deviance((square / variance).sum(),
                                              determinant + variance.log().sum()));
  }
  const double least = *std::min_element(deviances.begin(), deviances.end());
  double mean = 0.;
  for (const double deviance : deviances)
    mean += std::exp(-0.5 * (deviance - least) / decision.temperature) /
            static_cast<double>(deviances.size());
  return least / decision.temperature - 2. * std::log(mean) -
         2. * std::log(decision.prior_off_catalogue);
}

void add_triples(const Workbench &bench, const Decision &decision,
                 const std::vector<std::size_t> &simulated, std::vector<Scored> &models)
{
  constexpr std::size_t n_pairs = 4;
  std::vector<EffectSet> pairs;
  for (const Scored &model : models)
    if (model.fit.effects.size() == 2 && pairs.size() < n_pairs)
      pairs.push_back(model.fit.effects);
  std::set<EffectSet> triples;
  for (const EffectSet &pair : pairs)
    for (const std::size_t k : simulated)
      if (k != pair[0] && k != pair[1]) {
        EffectSet triple = {pair[0], pair[1], k};
        std::sort(triple.begin(), triple.end());
        triples.insert(triple);
      }
  for (const EffectSet &triple : triples)
    models.push_back(
        score(bench, decision, triple, static_cast<double>(simulated.size())));
}

} // namespace

bool is_simulated(const Workbench &bench, const std::size_t effect)
{
  const std::string &name = bench.effects[effect].name;
  return std::any_of(bench.runs.begin(), bench.runs.end(), [&](const auto &entry) {
    return entry.first.size() == 1 && entry.first.count(name) > 0 && !entry.second.empty();
  });
}

Posterior compare_models(const Workbench &bench, const Decision &decision)
{
  std::vector<std::size_t> simulated;
  for (std::size_t k = 0; k < bench.effects.size(); ++k)
    if (is_simulated(bench, k))
      simulated.push_back(k);
  const auto n_effects = static_cast<double>(simulated.size());

  Posterior posterior;
  const auto better = [](const Scored &a, const Scored &b) { return a.score < b.score; };
  for (const std::size_t k : simulated)
    posterior.models.push_back(score(bench, decision, {k}, n_effects));
  if (bench.options.max_effects >= 2)
    for (std::size_t a = 0; a < simulated.size(); ++a)
      for (std::size_t b = a + 1; b < simulated.size(); ++b)
        posterior.models.push_back(
            score(bench, decision, {simulated[a], simulated[b]}, n_effects));
  std::stable_sort(posterior.models.begin(), posterior.models.end(), better);
  if (bench.options.max_effects >= 3) {
    add_triples(bench, decision, simulated, posterior.models);
    std::stable_sort(posterior.models.begin(), posterior.models.end(), better);
  }

  const double off = score_off_catalogue(bench, decision, simulated);
  const double least = std::min(off, posterior.models.front().score);
  double sum = std::exp(-0.5 * (off - least));
  for (Scored &model : posterior.models)
    sum += model.probability = std::exp(-0.5 * (model.score - least));
  posterior.inclusion.assign(bench.effects.size(), 0.);
  for (Scored &model : posterior.models) {
    model.probability /= sum;
    for (const std::size_t k : model.fit.effects)
      posterior.inclusion[k] += model.probability;
  }
  posterior.off_catalogue = std::exp(-0.5 * (off - least)) / sum;
  return posterior;
}

} // namespace eunoe::discovery
