#include <eunoe/discovery/inference/amplitude_posterior.h>
#include <eunoe/discovery/inference/predictive.h>
#include <eunoe/discovery/statistics/covariance.h>

#include <boost/random/discrete_distribution.hpp>

#include <algorithm>

namespace eunoe::discovery {

double p_of_fit(const Evidence &evidence, const Model &model, const PosteriorDraws &posterior,
                const std::uint32_t seed)
{
  const Eigen::VectorXd &data = evidence.target().data();
  std::vector<Hypothesis> all;
  for (const Member &member : members(evidence, model, data))
    all.push_back(evidence.prepare(member.prediction));
  const auto misfits = [&](const Eigen::Ref<const Eigen::MatrixXd> &values) {
    Eigen::ArrayXd highest = Eigen::ArrayXd::Constant(values.cols(), -1e300);
    for (const Hypothesis &one : all)
      highest = highest.max(evidence.log_likelihoods(one, values));
    return Eigen::ArrayXd(-highest);
  };
  Twins source(evidence.target(), seed, Twins::Scatter::as_a_distance);
  Eigen::MatrixXd drawn(data.size(), static_cast<Eigen::Index>(posterior.size()));
  for (Eigen::Index i = 0; i < drawn.cols(); ++i) {
    const PosteriorDraw &draw = posterior[static_cast<std::size_t>(i)];
    Target::Prediction truth = evidence.target().predict(draw.effects);
    truth.mean += truth.gradient * draw.nuisances;
    truth.gradient.resize(truth.mean.size(), 0);
    drawn.col(i) = source.draw(truth);
  }
  return Tail(misfits(drawn)).p(misfits(data)(0));
}

NuisancePosterior nuisances_given(const Evidence &evidence, const EffectPositions &effects)
{
  const Eigen::VectorXd &data = evidence.target().data();
  const Hypothesis hypothesis = evidence.prepare(evidence.target().predict(effects));
  const Eigen::MatrixXd &gradient = hypothesis.prediction.gradient;
  const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(gradient.cols(), gradient.cols()),
                        scaled = gradient.transpose() *
                                 evidence.inverse_variance(hypothesis).asDiagonal();
  const Eigen::LLT<Eigen::MatrixXd> inner(unit + scaled * gradient);
  return {inner.solve(scaled * (data - hypothesis.prediction.mean)), inner.matrixU().solve(unit)};
}

PosteriorDraws draw_posterior(const Evidence &evidence, const Model &model,
                              const unsigned int draws, const std::uint32_t seed)
{
  RandomStream random(seed, 31);
  const Eigen::VectorXd &data = evidence.target().data();
  std::optional<AmplitudePosterior> alone;
  std::vector<Member> both;
  if (model.effects.size() == 1)
    alone.emplace(evidence, model, data, model.effects[0]);
  else if (!model.effects.empty())
    both = members(evidence, model, data);
  std::vector<double> probabilities;
  for (const Member &member : both)
    probabilities.push_back(member.probability);
  const boost::random::discrete_distribution<std::size_t> pick(probabilities);
  PosteriorDraws result;
  for (unsigned int i = 0; i < draws; ++i) {
    PosteriorDraw draw;
    if (alone)
      draw.effects[model.effects[0]] = alone->quantile(random.uniform());
    else if (!both.empty())
      draw.effects = both[pick(random)].effects;
    draw.given = nuisances_given(evidence, draw.effects);
    draw.nuisances =
        draw.given.mean + draw.given.root * random.normals(draw.given.mean.size(), 1).col(0);
    result.push_back(std::move(draw));
  }
  return result;
}

Predictive::Predictive(const Target &target, const PosteriorDraws &posterior,
                       const std::uint32_t seed)
{
  Twins source(target, seed), by_distance(target, seed, Twins::Scatter::as_a_distance);
  const Eigen::Index n = target.data().size();
  const auto draws = static_cast<Eigen::Index>(posterior.size());
  Eigen::MatrixXd means(n, draws), likely(n, draws); // a column for each draw
  Eigen::MatrixXd variances = Eigen::MatrixXd::Zero(n, Target::n_noise_levels);
  examples.resize(n, draws);
  for (Eigen::Index i = 0; i < draws; ++i) {
    const PosteriorDraw &draw = posterior[static_cast<std::size_t>(i)];
    Target::Prediction prediction = target.predict(draw.effects);
    all.push_back({prediction.mean + prediction.gradient * draw.given.mean,
                   target.variance(prediction), prediction.gradient * draw.given.root});
    variances += target.variances(prediction) / static_cast<double>(draws);
    prediction.mean += prediction.gradient * draw.nuisances;
    prediction.gradient.resize(n, 0);
    means.col(i) = prediction.mean;
    examples.col(i) = source.draw(prediction);
    likely.col(i) = by_distance.draw(prediction);
  }
  centre = means.rowwise().mean();
  const Eigen::MatrixXd spread = (means.colwise() - centre) *
                                 (means.colwise() - centre).transpose() /
                                 static_cast<double>(draws);
  const auto with = [&](const Eigen::VectorXd &variance) {
    return Eigen::MatrixXd(spread + Eigen::MatrixXd(variance.asDiagonal()));
  };
  llt.compute(with(variances.rowwise().mean()));
  for (Eigen::Index l = 0; l < variances.cols(); ++l)
    levels.emplace_back(with(variances.col(l)));
  tail = Tail(-log_density(likely));
}

Eigen::ArrayXd Predictive::log_density(const Eigen::Ref<const Eigen::MatrixXd> &data) const
{
  const Eigen::MatrixXd deviations = data.colwise() - centre;
  Eigen::ArrayXXd logs(static_cast<Eigen::Index>(levels.size()), data.cols());
  for (Eigen::Index l = 0; l < logs.rows(); ++l) {
    const Eigen::LLT<Eigen::MatrixXd> &level = levels[static_cast<std::size_t>(l)];
    logs.row(l) = -half_log_determinant(level) -
                  0.5 * level.matrixL().solve(deviations).colwise().squaredNorm().array();
  }
  return log_sums(logs);
}

Contest::Contest(std::vector<Predictive> competing) : models(std::move(competing))
{
  for (std::size_t m = 0; m < models.size(); ++m)
    tails.emplace_back(advantage(m, log_densities(models[m].twins())));
}

Eigen::ArrayXXd Contest::log_densities(const Eigen::Ref<const Eigen::MatrixXd> &data) const
{
  Eigen::ArrayXXd result(static_cast<Eigen::Index>(models.size()), data.cols());
  for (std::size_t m = 0; m < models.size(); ++m)
    result.row(static_cast<Eigen::Index>(m)) = models[m].log_density(data).transpose();
  return result;
}

Eigen::ArrayXd Contest::advantage(const std::size_t model, const Eigen::ArrayXXd &log_densities)
{
  const auto m = static_cast<Eigen::Index>(model);
  Eigen::ArrayXXd others = log_densities;
  others.row(m) = -1e300;
  return (others.colwise().maxCoeff() - log_densities.row(m)).transpose();
}

Eigen::ArrayXd Contest::p_values(const std::size_t model,
                                 const Eigen::Ref<const Eigen::MatrixXd> &data) const
{
  const Eigen::ArrayXXd densities = log_densities(data);
  const Eigen::ArrayXd ahead = advantage(model, densities);
  Eigen::ArrayXd result(data.cols());
  for (Eigen::Index k = 0; k < data.cols(); ++k) {
    const double alone = models[model].p(densities(static_cast<Eigen::Index>(model), k));
    // Where a model is the best, nothing speaks for another one, however rare that distance is.
    const double beside_others = ahead(k) > 0. ? tails[model].p(ahead(k)) : 1.;
    const double tests = std::min<double>(2., static_cast<double>(models.size())); // Bonferroni
    result(k) = std::min(1., tests * std::min(alone, beside_others));
  }
  return result;
}

double Contest::refuted_by(const std::size_t model, const std::size_t truth,
                           const double level) const
{
  return (p_values(model, models[truth].twins()) < level).cast<double>().mean();
}

double Contest::passes(const std::size_t model, const std::vector<std::size_t> &others,
                       const double level) const
{
  double passed = 1.;
  for (const std::size_t other : others)
    passed += 1. - refuted_by(model, other, level);
  return passed / (2. + static_cast<double>(others.size()));
}

} // namespace eunoe::discovery
