#include <eunoe/discovery/inference/evidence.h>
#include <eunoe/discovery/statistics/covariance.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace eunoe::discovery {

namespace {

/// Places on each side of an effect's null value, and how many of them are left out in pairs.
constexpr int n_places = 60, pair_stride = 4;

Target::Prediction sum(const Target::Prediction &a, const Target::Prediction &b,
                       const Target::Prediction &base)
{
  return {a.mean + b.mean - base.mean, a.gradient + b.gradient - base.gradient,
          (a.leverage + b.leverage - base.leverage).cwiseMax(1e-4),
          a.scatter.cwiseProduct(b.scatter), a.common.cwiseProduct(b.common)};
}

} // namespace

bool is_among(const Model &model, const std::vector<Model> &models)
{
  return std::any_of(models.begin(), models.end(),
                     [&](const Model &other) { return other.effects == model.effects; });
}

bool is_part(const Model &part, const Model &whole)
{
  return std::includes(whole.effects.begin(), whole.effects.end(), part.effects.begin(),
                       part.effects.end());
}

void temper(std::vector<Model> &models, const double temperature)
{
  std::vector<double> logs;
  for (const Model &model : models)
    logs.push_back(model.log_prior + model.log_evidence / temperature);
  const std::vector<double> shares = shares_of(std::move(logs));
  for (std::size_t m = 0; m < models.size(); ++m)
    models[m].probability = shares[m];
  sort_by_probability(models);
}

void sort_by_probability(std::vector<Model> &models)
{
  std::stable_sort(models.begin(), models.end(),
                   [](const Model &a, const Model &b) { return a.probability > b.probability; });
}

Evidence::Evidence(const Target &target, const FactorSpace &space)
    : Likelihood(target), factors(space), grid(space.n_effects())
{
  for (std::size_t k = 0; k < space.n_effects(); ++k) {
    if (target.knows(k))
      make_grid(k);
    if (!grid[k].empty())
      effects.push_back(k);
  }
  discrepancies = make_discrepancies();
}

std::vector<double> Evidence::optimistic(const std::size_t effect, const double deviations) const
{
  std::vector<double> values;
  for (const Place &place : grid[effect])
    values.push_back(place.log_prior +
                     std::log(prior.one_effect / static_cast<double>(effects.size())) +
                     log_optimistic(place.hypothesis, deviations));
  return values;
}

double Evidence::optimistic_pair(const Model &pair) const
{
  const Hypothesis best = prepare(target().predict(pair.best));
  return pair.log_prior + pair.log_evidence + log_optimistic(best) -
         log_likelihood(best, target().data());
}

/// Amplitudes from the smallest that could be seen to the end of the range. Equal ratios of
/// strength are equally likely, and a little of the probability is shared by equal ratios of
/// amplitude: the prior does not depend on how an effect is parametrised, and favours none for its
/// narrow range.
void Evidence::make_grid(const std::size_t k)
{
  constexpr double least_ratio = 1.25;
  for (const double limit : {factors.lower(k), factors.upper(k)}) {
    if (limit == 0.)
      continue;
    double first = std::min(prior.least_range, 0.5 * std::abs(limit)) * (limit < 0. ? -1. : 1.);
    while (std::abs(first) * least_ratio < std::abs(limit) &&
           change(target().predict({{k, first}})).norm() < prior.just_visible)
      first *= least_ratio;
    std::vector<Place> side;
    double strongest = prior.just_visible;
    for (int i = 0; i < n_places; ++i) {
      const double u = first * std::pow(limit / first, i / (n_places - 1.));
      const Target::Prediction with = target().predict({{k, u}});
      const double square = change(with).squaredNorm() - with.leverage.sum();
      strongest = std::max(strongest, std::sqrt(std::max(0., square)));
      side.push_back({u, 0., 0., strongest, prepare(with)});
    }
    const double step = std::log(limit / first) / (n_places - 1.);
    const double whole = std::log(side.back().strength / prior.just_visible) + prior.by_amplitude;
    for (std::size_t i = 0; i < side.size(); ++i) {
      const double here = side[i].strength, below = i == 0 ? here : side[i - 1].strength,
                   above = i + 1 == side.size() ? here : side[i + 1].strength;
      const auto mixed = [&](const double by_strength, const double by_amplitude) {
        return std::log((1. - prior.by_amplitude) * by_strength +
                        prior.by_amplitude * by_amplitude);
      };
      side[i].log_prior = mixed(0.5 * std::log(above / below), whole / n_places);
      side[i].log_reference = mixed(0.5 * (above - below), step * here);
    }
    grid[k].insert(grid[k].end(), side.begin(), side.end());
  }
  double sum = 0.;
  for (const Place &place : grid[k])
    sum += std::exp(place.log_prior);
  for (Place &place : grid[k])
    place.log_prior -= std::log(sum);
}

/// "None of these" is a change of any size, a share of it along directions like those of the
/// catalogue's effects, the rest along any.
std::vector<Evidence::Covariance> Evidence::make_discrepancies() const
{
  const Eigen::Index n = target().data().size();
  Eigen::MatrixXd along = Eigen::MatrixXd::Zero(n, n);
  for (const auto &places : grid)
    for (std::size_t i = n_places / 2; i < places.size(); i += n_places) {
      const Target::Prediction &with = places[i].hypothesis.prediction;
      const Eigen::VectorXd moved = change(with);
      const double noise = with.leverage.sum(), square = moved.squaredNorm();
      if (square > noise)
        along += moved * moved.transpose() / square * (1. - noise / square);
    }
  const double trace = along.trace();
  Eigen::MatrixXd shape = Eigen::MatrixXd::Identity(n, n) / static_cast<double>(n);
  if (trace > 0.)
    shape = (1. - prior.along_effects) * shape + prior.along_effects * along / trace;
  std::vector<Covariance> result;
  for (Eigen::Index l = 0; l < nothing().inverse.cols(); ++l) {
    Eigen::MatrixXd noise =
        nothing().prediction.gradient * nothing().prediction.gradient.transpose();
    noise.diagonal() += nothing().inverse.col(l).cwiseInverse();
    for (double strength = prior.weakest_discrepancy; strength <= prior.strongest_discrepancy;
         strength *= 2.)
      result.emplace_back(noise + strength * strength * shape);
  }
  return result;
}

Eigen::ArrayXXd Evidence::log_of_places(const std::size_t effect,
                                        const Eigen::Ref<const Eigen::MatrixXd> &data) const
{
  Eigen::ArrayXXd result(static_cast<Eigen::Index>(grid[effect].size()), data.cols());
  for (Eigen::Index i = 0; i < result.rows(); ++i) {
    const Place &place = grid[effect][static_cast<std::size_t>(i)];
    result.row(i) = place.log_prior + log_likelihoods(place.hypothesis, data).transpose();
  }
  return result;
}

Model Evidence::single(const std::size_t effect, const Eigen::VectorXd &data) const
{
  const Eigen::ArrayXXd of_places = log_of_places(effect, data);
  Eigen::Index best = 0;
  of_places.col(0).maxCoeff(&best);
  Model model;
  model.effects = {effect};
  model.log_prior = std::log(prior.one_effect / static_cast<double>(effects.size()));
  model.log_evidence = log_sums(of_places)(0);
  model.best[effect] = grid[effect][static_cast<std::size_t>(best)].amplitude;
  return model;
}

Eigen::ArrayXd Evidence::log_discrepancy(const Eigen::Ref<const Eigen::MatrixXd> &data) const
{
  const Eigen::MatrixXd deviations = data.colwise() - nothing().prediction.mean;
  const auto number = static_cast<Eigen::Index>(discrepancies.size());
  Eigen::ArrayXXd distances(number, data.cols());
  Eigen::ArrayXd constants(number);
  for (Eigen::Index i = 0; i < number; ++i) {
    const Covariance &llt = discrepancies[static_cast<std::size_t>(i)];
    constants(i) = -half_log_determinant(llt);
    distances.row(i) = llt.matrixL().solve(deviations).colwise().squaredNorm();
  }
  return log_sums(log_t(constants, distances)) - std::log(static_cast<double>(number));
}

Evidence::Singles Evidence::singles(const Eigen::Ref<const Eigen::MatrixXd> &data,
                                    const std::optional<std::size_t> without) const
{
  const auto n = static_cast<Eigen::Index>(effects.size());
  const double total = prior.one_effect + prior.none_of_these;
  const double of_each = prior.one_effect / static_cast<double>(without ? n - 1 : n) / total;
  Singles result{Eigen::ArrayXd::Constant(n + 1, std::log(of_each)),
                 Eigen::ArrayXXd::Zero(n + 1, data.cols())};
  for (Eigen::Index i = 0; i < n; ++i)
    if (const std::size_t k = effects[static_cast<std::size_t>(i)]; k == without)
      result.log_prior(i) = -std::numeric_limits<double>::infinity();
    else
      result.log_evidence.row(i) = log_sums(log_of_places(k, data)).transpose();
  result.log_prior(n) = std::log(prior.none_of_these / total);
  result.log_evidence.row(n) = log_discrepancy(data).transpose();
  return result;
}

Eigen::ArrayXd Evidence::log_bayes_factors(const Eigen::Ref<const Eigen::MatrixXd> &data) const
{
  return log_sums(singles(data).log_posterior()) - log_nothing(data);
}

void Evidence::integrate(Model &pair, const Eigen::VectorXd &data, const bool roughly) const
{
  const std::size_t a = pair.effects[0], b = pair.effects[1];
  std::vector<double> values;
  double highest = -1e300, weight = 0.;
  for (std::size_t i = pair_stride / 2; i < grid[a].size(); i += pair_stride)
    for (std::size_t j = pair_stride / 2; j < grid[b].size(); j += pair_stride) {
      const Place &p = grid[a][i], &q = grid[b][j];
      const Target::Prediction both =
          sum(p.hypothesis.prediction, q.hypothesis.prediction, nothing().prediction);
      values.push_back(
          p.log_prior + q.log_prior +
          log_likelihood(prepare(both, roughly ? Eigen::MatrixXd(target().variance(both))
                                               : target().variances(both)),
                         data));
      weight += std::exp(p.log_prior + q.log_prior);
      if (values.back() > highest) {
        highest = values.back();
        pair.best = {{a, p.amplitude}, {b, q.amplitude}};
      }
    }
  pair.log_evidence = log_sum(values) - std::log(weight);
}

/// Log of the prior density of an amplitude's logarithm.
double Evidence::log_density(const std::size_t effect, const double amplitude) const
{
  const Place *const side = side_of(effect, amplitude);
  const double size = std::abs(amplitude), first = std::abs(side[0].amplitude);
  if (size < first || size > std::abs(side[n_places - 1].amplitude))
    return -std::numeric_limits<double>::infinity();
  return place_near(effect, amplitude).log_prior -
         std::log(std::log(side[1].amplitude / side[0].amplitude));
}

/// The grid of pairs is coarse. Newton's method finds the likeliest logarithms of both amplitudes,
/// and the evidence is a sum along the axes of the normal distribution there (Laplace), as far as
/// the prior reaches: an effect that is not needed is as likely wherever it cannot be seen.
void Evidence::polish(Model &model, const Eigen::VectorXd &data) const
{
  constexpr double step = 0.05, longest = 0.5;
  constexpr int iterations = 4;
  const std::size_t a = model.effects[0], b = model.effects[1];
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  const auto amplitude = [&](const std::size_t k, const double shift) {
    return std::clamp(model.best.at(k) * std::exp(shift), factors.lower(k), factors.upper(k));
  };
  const auto log_at = [&](const double u, const double v) {
    return log_likelihood(prepare(target().predict({{a, u}, {b, v}})), data);
  };
  const auto f = [&](const double x, const double y) {
    return log_at(amplitude(a, at(0) + x), amplitude(b, at(1) + y));
  };
  Eigen::Matrix2d curvature;
  for (int i = 0; i <= iterations; ++i) {
    const double value = f(0., 0.);
    const double left = f(-step, 0.), right = f(step, 0.), down = f(0., -step), up = f(0., step);
    const double cross = (f(step, step) + f(-step, -step) + 2. * value - left - right - down - up) /
                         (2. * step * step);
    curvature << (2. * value - left - right) / (step * step), -cross, -cross,
        (2. * value - down - up) / (step * step);
    if (curvature(0, 0) <= 0. || curvature.determinant() <= 0.)
      return;
    const Eigen::Vector2d slope((right - left) / (2. * step), (up - down) / (2. * step));
    if (i < iterations)
      at += curvature.inverse() * slope.cwiseMin(1e3).cwiseMax(-1e3);
    at = at.cwiseMin(longest).cwiseMax(-longest);
  }
  constexpr int to_each_side = 4;
  constexpr double spacing = 0.9;
  const Eigen::Matrix2d axes =
      spacing * Eigen::Matrix2d(Eigen::Matrix2d(curvature.inverse()).llt().matrixL());
  std::vector<double> logs;
  for (int i = -to_each_side; i <= to_each_side; ++i)
    for (int j = -to_each_side; j <= to_each_side; ++j) {
      const Eigen::Vector2d shift = at + axes * Eigen::Vector2d(i, j);
      const double u = model.best.at(a) * std::exp(shift(0)),
                   v = model.best.at(b) * std::exp(shift(1));
      const double log_prior = log_density(a, u) + log_density(b, v);
      if (std::isfinite(log_prior))
        logs.push_back(log_prior + log_at(u, v));
    }
  model.best = {{a, amplitude(a, at(0))}, {b, amplitude(b, at(1))}};
  if (!logs.empty())
    model.log_evidence = log_sum(logs) + std::log(axes.determinant());
}

const Evidence::Place *Evidence::side_of(const std::size_t effect, const double amplitude) const
{
  const std::vector<Place> &places = grid[effect];
  return places.data() + ((amplitude > 0.) == (places.front().amplitude > 0.) ? 0 : n_places);
}

const Evidence::Place &Evidence::place_near(const std::size_t effect, const double amplitude) const
{
  const Place *const side = side_of(effect, amplitude);
  const double first = side[0].amplitude;
  const double place = std::log(amplitude / first) / std::log(side[1].amplitude / first);
  return side[std::clamp(std::lround(place), 0l, n_places - 1l)];
}

std::vector<Model> Evidence::models(const Eigen::VectorXd &data) const
{
  std::vector<Model> all(1);
  all[0].is_discrepancy = true;
  all[0].log_prior = std::log(prior.none_of_these);
  all[0].log_evidence = log_discrepancy(data)(0);
  const auto n = static_cast<double>(effects.size());
  for (const std::size_t k : effects)
    all.push_back(single(k, data));
  for (std::size_t i = 0; i < effects.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      Model two;
      two.effects = {effects[j], effects[i]};
      two.log_prior = std::log(prior.two_effects / (0.5 * n * (n - 1.)));
      integrate(two, data, true);
      all.push_back(two);
    }
  double highest = all.front().log_prior + all.front().log_evidence;
  for (const Model &model : all)
    highest = std::max(highest, model.log_prior + model.log_evidence);
  for (Model &model : all) {
    constexpr double within = 15.;
    if (model.effects.size() == 2 && model.log_prior + model.log_evidence > highest - within) {
      integrate(model, data, false);
      polish(model, data);
    }
  }
  temper(all, 1.);
  return all;
}

} // namespace eunoe::discovery
