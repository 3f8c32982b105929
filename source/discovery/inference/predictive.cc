#include <eunoe/discovery/inference/predictive.h>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

namespace {

/// Amplitudes near the best of a set, by a normal approximation: how far one amplitude may move
/// until the likelihood falls to its standard error.
double log_error(const Evidence &evidence, std::map<std::size_t, double> effects,
                 const std::size_t moved, const Eigen::VectorXd &data)
{
  constexpr double step = 0.05, least = 1e-4, most = 0.7;
  const auto at = [&](const double shift) {
    std::map<std::size_t, double> other = effects;
    other[moved] *= std::exp(shift);
    return evidence.log_likelihood(evidence.prepare(evidence.target().predict(other)), data);
  };
  const double curvature = (2. * at(0.) - at(step) - at(-step)) / (step * step);
  return std::min(most, 1. / std::sqrt(std::max(curvature, least)));
}

/// What a model may be at other amplitudes than the best: all places of one effect, and for several
/// a grid about the best, as wide as the data leave them uncertain.
std::vector<Evidence::Hypothesis> family(const Evidence &evidence, const Model &model,
                                         const Eigen::VectorXd &data)
{
  std::vector<Evidence::Hypothesis> members;
  if (model.effects.size() == 1) {
    for (const Evidence::Place &place : evidence.places(model.effects[0]))
      members.push_back(place.hypothesis);
    return members;
  }
  constexpr int on_each_side = 4;
  constexpr double farthest = 2.5;
  std::vector<std::map<std::size_t, double>> grid = {model.best};
  for (const std::size_t k : model.effects) {
    const double error = log_error(evidence, model.best, k, data);
    std::vector<std::map<std::size_t, double>> wider;
    for (const auto &point : grid)
      for (int i = -on_each_side; i <= on_each_side; ++i) {
        wider.push_back(point);
        wider.back()[k] = std::clamp(point.at(k) * std::exp(farthest * error * i / on_each_side),
                                     evidence.space().lower(k), evidence.space().upper(k));
      }
    grid = std::move(wider);
  }
  for (const auto &effects : grid)
    members.push_back(evidence.prepare(evidence.target().predict(effects)));
  return members;
}

} // namespace

double p_of_fit(const Evidence &evidence, const Model &model, const PosteriorDraws &posterior,
                const std::uint32_t seed)
{
  const Eigen::VectorXd &data = evidence.target().data();
  const std::vector<Evidence::Hypothesis> members = family(evidence, model, data);
  const auto misfit = [&](const Eigen::VectorXd &values) {
    std::vector<double> likelihoods;
    for (const Evidence::Hypothesis &member : members)
      likelihoods.push_back(evidence.log_likelihood(member, values));
    const auto best = std::max_element(likelihoods.begin(), likelihoods.end());
    return evidence.distance(members[static_cast<std::size_t>(best - likelihoods.begin())], values);
  };
  Twins source(evidence, seed);
  std::vector<double> misfits;
  for (std::size_t i = 0; i < posterior.effects.size(); ++i) {
    Target::Prediction truth = evidence.target().predict(posterior.effects[i]);
    truth.mean += truth.gradient * posterior.nuisances[i];
    truth.gradient.resize(truth.mean.size(), 0);
    misfits.push_back(misfit(source.draw(truth)));
  }
  return Tail(std::move(misfits)).p(misfit(data));
}

Eigen::VectorXd best_nuisances(const Evidence &evidence, const Evidence::Hypothesis &hypothesis)
{
  const Eigen::MatrixXd &gradient = hypothesis.prediction.gradient;
  const Eigen::MatrixXd scaled = gradient.transpose() * hypothesis.inverse.asDiagonal();
  const Eigen::MatrixXd inner =
      Eigen::MatrixXd::Identity(gradient.cols(), gradient.cols()) + scaled * gradient;
  return inner.llt().solve(scaled * (evidence.target().data() - hypothesis.prediction.mean));
}

PosteriorDraws draw_posterior(const Evidence &evidence, const Model &model,
                              const unsigned int draws, const std::uint32_t seed)
{
  RandomStream random(seed, 31);
  const Eigen::VectorXd &data = evidence.target().data();
  std::map<std::size_t, double> errors;
  if (model.effects.size() > 1)
    for (const std::size_t k : model.effects)
      errors[k] = log_error(evidence, model.best, k, data);
  std::optional<AmplitudePosterior> posterior;
  if (model.effects.size() == 1)
    posterior = amplitude_posterior(evidence, model.effects[0], data);
  PosteriorDraws result;
  for (unsigned int i = 0; i < draws; ++i) {
    std::map<std::size_t, double> effects = model.best;
    if (posterior)
      effects[model.effects[0]] = posterior->quantile(random.uniform());
    else
      for (auto &[k, amplitude] : effects)
        amplitude = std::clamp(amplitude * std::exp(errors.at(k) * random.normal()),
                               evidence.space().lower(k), evidence.space().upper(k));
    const Evidence::Hypothesis hypothesis = evidence.prepare(evidence.target().predict(effects));
    const Eigen::MatrixXd &gradient = hypothesis.prediction.gradient;
    const Eigen::Index n = gradient.cols();
    const Eigen::LLT<Eigen::MatrixXd> inner(Eigen::MatrixXd::Identity(n, n) +
                                            gradient.transpose() * hypothesis.inverse.asDiagonal() *
                                                gradient);
    result.effects.push_back(effects);
    result.nuisance_means.push_back(best_nuisances(evidence, hypothesis));
    result.nuisance_roots.emplace_back(inner.matrixU().solve(Eigen::MatrixXd::Identity(n, n)));
    result.nuisances.push_back(result.nuisance_means.back() +
                               inner.matrixU().solve(random.normals(n, 1)).col(0));
  }
  return result;
}

Predictive::Predictive(const Evidence &evidence, const PosteriorDraws &posterior,
                       const std::uint32_t seed)
{
  Twins source(evidence, seed);
  const Target &target = evidence.target();
  const Eigen::Index n = target.data().size();
  const auto draws = static_cast<Eigen::Index>(posterior.effects.size());
  Eigen::MatrixXd means(n, draws), variances(n, draws); // a column for each draw
  for (Eigen::Index i = 0; i < draws; ++i) {
    const auto k = static_cast<std::size_t>(i);
    Target::Prediction prediction = target.predict(posterior.effects[k]);
    Conditional one;
    one.mean = prediction.mean + prediction.gradient * posterior.nuisance_means[k];
    one.columns = prediction.gradient * posterior.nuisance_roots[k];
    prediction.mean += prediction.gradient * posterior.nuisances[k];
    one.variance = variances.col(i) = target.variance(prediction);
    means.col(i) = prediction.mean;
    prediction.gradient.resize(n, 0);
    one.twin = source.draw(prediction);
    all.push_back(one);
  }
  centre = means.rowwise().mean();
  Eigen::MatrixXd covariance = (means.colwise() - centre) * (means.colwise() - centre).transpose() /
                               static_cast<double>(draws);
  covariance.diagonal() += variances.rowwise().mean();
  llt.compute(covariance);
  std::vector<double> distances;
  for (const Conditional &one : all)
    distances.push_back(distance(one.twin));
  tail = Tail(std::move(distances));
}

double Predictive::distance(const Eigen::VectorXd &data) const
{
  return llt.matrixL().solve(data - centre).squaredNorm();
}

double Predictive::refuted_by(const Predictive &truth, const double level) const
{
  const auto refuted = std::count_if(truth.all.begin(), truth.all.end(),
                                     [&](const Conditional &one) { return p(one.twin) < level; });
  return static_cast<double>(refuted) / static_cast<double>(truth.all.size());
}

} // namespace eunoe::discovery
