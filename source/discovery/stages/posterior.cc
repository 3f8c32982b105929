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

ScoredModel score(const StudyState &study, const DecisionRule &decision, const EffectSet &set,
                  const double n_effects)
{
  ScoredModel scored;
  scored.fit = fit_model(study, set);
  const std::size_t size = set.size();
  scored.score = scored.fit.deviance / decision.temperature +
                 decision.cost_of_effect * static_cast<double>(size) -
                 2. * std::log(decision.prior_of_size[size - 1] / choose(n_effects, size));
  return scored;
}

/// -2 log evidence of "off catalogue": a change of unknown size, with directions distributed like
/// the catalogue's fingerprints and, to a smaller part, evenly.
double score_off_catalogue(const StudyState &study, const DecisionRule &decision,
                           const std::vector<std::size_t> &simulated)
{
  constexpr double share_of_fingerprints = 0.7;
  const Eigen::Index n = study.misfit.size();
  Eigen::MatrixXd directions =
      Eigen::MatrixXd::Identity(n, n) * ((1. - share_of_fingerprints) / static_cast<double>(n));
  for (const std::size_t k : simulated) {
    const Emulator emulator = study.emulator({k});
    const Bounds range = bounds(study, {k}, emulator);
    Eigen::VectorXd change =
        emulator.change(range.upper(0) > -range.lower(0) ? range.upper : range.lower);
    if (change.norm() > 0.)
      change.normalize();
    directions +=
        change * change.transpose() * share_of_fingerprints / static_cast<double>(simulated.size());
  }
  const Fit base = fit_model(study, {});
  const Eigen::VectorXd deviation = study.misfit.variance(base.leverage).cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(deviation.asDiagonal() * directions *
                                                             deviation.asDiagonal());
  const Eigen::ArrayXd square =
      (eigen.eigenvectors().transpose() * deviation.cwiseProduct(base.remainder)).array().square();
  const double determinant = study.misfit.log_determinant(base.leverage);

  std::vector<double> deviances;
  for (double strength = 1.; strength < 130.; strength *= std::sqrt(2.)) {
    const Eigen::ArrayXd variance = 1. + strength * strength * eigen.eigenvalues().array().max(0.);
    deviances.push_back(
        study.misfit.deviance((square / variance).sum(), determinant + variance.log().sum()));
  }
  const double least = *std::min_element(deviances.begin(), deviances.end());
  double mean = 0.;
  for (const double deviance : deviances)
    mean += std::exp(-0.5 * (deviance - least) / decision.temperature) /
            static_cast<double>(deviances.size());
  return least / decision.temperature - 2. * std::log(mean) -
         2. * std::log(decision.prior_off_catalogue);
}

void add_triples(const StudyState &study, const DecisionRule &decision,
                 const std::vector<std::size_t> &simulated, std::vector<ScoredModel> &models)
{
  constexpr std::size_t n_pairs = 4;
  std::vector<EffectSet> pairs;
  for (const ScoredModel &model : models)
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
    models.push_back(score(study, decision, triple, static_cast<double>(simulated.size())));
}

} // namespace

bool is_simulated(const StudyState &study, const std::size_t effect)
{
  const std::string &name = study.effects[effect].name;
  return std::any_of(study.replicates.begin(), study.replicates.end(), [&](const auto &entry) {
    return entry.first.size() == 1 && entry.first.count(name) > 0 && !entry.second.empty();
  });
}

Posterior compare_models(const StudyState &study, const DecisionRule &decision)
{
  std::vector<std::size_t> simulated;
  for (std::size_t k = 0; k < study.effects.size(); ++k)
    if (is_simulated(study, k))
      simulated.push_back(k);
  const auto n_effects = static_cast<double>(simulated.size());

  Posterior posterior;
  const auto better = [](const ScoredModel &a, const ScoredModel &b) { return a.score < b.score; };
  for (const std::size_t k : simulated)
    posterior.models.push_back(score(study, decision, {k}, n_effects));
  if (study.options.max_effects >= 2)
    for (std::size_t a = 0; a < simulated.size(); ++a)
      for (std::size_t b = a + 1; b < simulated.size(); ++b)
        posterior.models.push_back(score(study, decision, {simulated[a], simulated[b]}, n_effects));
  std::stable_sort(posterior.models.begin(), posterior.models.end(), better);
  if (study.options.max_effects >= 3) {
    add_triples(study, decision, simulated, posterior.models);
    std::stable_sort(posterior.models.begin(), posterior.models.end(), better);
  }

  const double off = score_off_catalogue(study, decision, simulated);
  const double least = std::min(off, posterior.models.front().score);
  double sum = std::exp(-0.5 * (off - least));
  for (ScoredModel &model : posterior.models)
    sum += model.probability = std::exp(-0.5 * (model.score - least));
  posterior.inclusion.assign(study.effects.size(), 0.);
  for (ScoredModel &model : posterior.models) {
    model.probability /= sum;
    for (const std::size_t k : model.fit.effects)
      posterior.inclusion[k] += model.probability;
  }
  posterior.off_catalogue = std::exp(-0.5 * (off - least)) / sum;
  return posterior;
}

} // namespace eunoe::discovery
