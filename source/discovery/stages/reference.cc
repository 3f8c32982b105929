#include <eunoe/discovery/stages/models.h>
#include <eunoe/discovery/stages/reference.h>
#include <eunoe/discovery/statistics/random_stream.h>

#include <boost/math/distributions/chi_squared.hpp>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

namespace {

constexpr int n_draws = 499;

double share_at_least(const std::vector<Evidence> &draws, double Evidence::*member,
                      const double value)
{
  const auto count = std::count_if(draws.begin(), draws.end(),
                                   [&](const Evidence &draw) { return draw.*member >= value; });
  return (1. + static_cast<double>(count)) / (1. + static_cast<double>(draws.size()));
}

double chi_square_beyond(const double value, const double degrees_of_freedom)
{
  if (value <= 0.)
    return 1.;
  return boost::math::cdf(
      boost::math::complement(boost::math::chi_squared(degrees_of_freedom), value));
}

/// The largest of several independent deviations.
double bonferroni(const double p, const double n)
{
  return std::min(1., n * p);
}

/// Fall of deviance along the fingerprint of one effect, whatever its sign and size.
double gain_along(const Misfit &misfit, const Eigen::VectorXd &direction,
                  const Eigen::VectorXd &deviation, const double leverage)
{
  const Eigen::VectorXd weight = misfit.variance(leverage).cwiseInverse();
  const double product = direction.dot(weight.cwiseProduct(deviation));
  const double square = direction.dot(weight.cwiseProduct(direction));
  const double distance = misfit.distance(deviation, leverage);
  const double explained = square > 0. ? product * product / square : 0.;
  return misfit.deviance(distance, 0.) - misfit.deviance(distance - explained, 0.);
}

/// F distribution with the mean and variance of these distances; Misfit::Tail tells its meaning.
Misfit::Tail fit_tail(const std::vector<Evidence> &draws, const double n)
{
  double mean = 0., square = 0.;
  for (const Evidence &draw : draws) {
    mean += draw.distance / static_cast<double>(draws.size());
    square += draw.distance * draw.distance / static_cast<double>(draws.size());
  }
  const double spread = (square - mean * mean) / (mean * mean), x = 0.5 * spread * n;
  Misfit::Tail tail;
  tail.degrees_of_freedom = x > 1.001 ? std::clamp((4. * x + n - 2.) / (x - 1.), 6., 1e6) : 1e6;
  tail.inflation = mean / n * (tail.degrees_of_freedom - 2.) / tail.degrees_of_freedom;
  return tail;
}

/// One study in which nothing is missing.
class Draw
{
public:
  explicit Draw(const Workbench &bench)
      : bench(bench), lower(Eigen::LLT<Eigen::MatrixXd>(bench.chaos.unshrunk).matrixL()),
        most_repeats(static_cast<Eigen::Index>(bench.repeats.maxCoeff())),
        fine((1. - (bench.modes.basis().transpose() * bench.chaos.matrix * bench.modes.basis())
                       .diagonal()
                       .array())
                 .max(0.)
                 .sqrt())
  {
  }

  void make(RandomStream &random)
  {
    const Eigen::MatrixXd base = runs(static_cast<Eigen::Index>(bench.base().size()), random);
    const Eigen::Index n = bench.modes.n_cells();
    // Runs of other models, of which only deviations from their means are used.
    const auto others =
        static_cast<Eigen::Index>(bench.chaos_degrees_of_freedom + 0.5) - (base.rows() - 1);
    Eigen::MatrixXd deviations(base.rows() + others, bench.modes.n_modes());
    deviations << centred(base * bench.modes.basis().transpose()),
        random.normals(others, lower.rows()) * lower.transpose();
    const Covariance chaos = shrunk_covariance(deviations, bench.chaos_degrees_of_freedom,
                                               bench.modes.experiment_of_mode());
    const Eigen::VectorXd cell_chaos =
        (centred(base).colwise().squaredNorm().transpose() / static_cast<double>(base.rows() - 1))
            .cwiseMax(1e-6);
    Repeats repeats{Eigen::VectorXd(n), bench.repeats};
    const Eigen::VectorXd data = measure(random, repeats);
    const DataNoise noise = estimate_data_noise(bench.modes, chaos.matrix, cell_chaos, repeats);
    const Eigen::VectorXd cells = data - base.colwise().mean().transpose();
    const double leverage = 1. / static_cast<double>(base.rows());
    misfit = Misfit(chaos.matrix, bench.other_covariance(noise, chaos.matrix));
    misfit.tail = bench.misfit.tail;
    deviation = misfit.coordinates(bench.modes.basis() * cells);
    base_shift = bench.modes.basis() * base.colwise().mean().transpose();
    evidence = {};
    evidence.distance = misfit.distance(deviation, leverage);
    Eigen::VectorXd variance = noise.cell_variance + (leverage + bench.nuisance_noise) * cell_chaos;
    variance += bench.nuisance_cells.rowwise().squaredNorm() + bench.tolerance().cwiseAbs2();
    evidence.cell = (cells.array() / variance.array().sqrt()).abs().maxCoeff();
  }

  Misfit misfit;
  Eigen::VectorXd deviation;  ///< data less base model, in coordinates of the misfit
  Eigen::VectorXd base_shift; ///< of the base model's mean, in modes
  Evidence evidence;

private:
  /// Values of all cells in some runs, in units of their chaos.
  Eigen::MatrixXd runs(const Eigen::Index number, RandomStream &random) const
  {
    Eigen::MatrixXd cells =
        random.normals(number, lower.rows()) * lower.transpose() * bench.modes.basis();
    // What the modes leave out, the finest waves of long profiles.
    if (fine.maxCoeff() > 1e-3)
      cells += random.normals(number, cells.cols()) * fine.matrix().asDiagonal();
    return cells;
  }

  Eigen::VectorXd measure(RandomStream &random, Repeats &repeats) const
  {
    const Eigen::Index n = bench.modes.n_cells();
    const Eigen::VectorXd &ratio = bench.noise.ratio;
    Eigen::MatrixXd rows = runs(most_repeats, random) * ratio.cwiseMin(1.).cwiseSqrt().asDiagonal();
    rows +=
        random.normals(most_repeats, n) * (ratio.array() - 1.).max(0.).sqrt().matrix().asDiagonal();
    const Eigen::VectorXd jitter =
        random.normals(1, bench.nuisance_cells.cols()).row(0).transpose();
    Eigen::VectorXd mean = bench.nuisance_cells * jitter;
    mean += std::sqrt(bench.nuisance_noise) * runs(1, random).row(0).transpose();
    const Eigen::VectorXd tolerance = bench.tolerance() * std::sqrt(0.5);
    for (const Modes::Group &group : bench.modes.groups()) {
      const double common = random.normal();
      for (const Eigen::Index c : group.cells) {
        const auto number = static_cast<Eigen::Index>(bench.repeats(c));
        const Eigen::VectorXd column = rows.col(c).head(number);
        mean(c) += column.mean() + tolerance(c) * (common + random.normal());
        repeats.deviation(c) = number > 1
                                   ? std::sqrt((column.array() - column.mean()).square().sum() /
                                               static_cast<double>(number - 1))
                                   : bench.deviation(c) / bench.modes.deviations()(c);
      }
    }
    return mean;
  }

  const Workbench &bench;
  const Eigen::MatrixXd lower;
  const Eigen::Index most_repeats;
  const Eigen::ArrayXd fine;
};

/// Largest fall of deviance that one effect brings.
double largest_gain(const Workbench &bench, const Misfit &misfit,
                    const std::vector<Response> &responses, const Eigen::VectorXd &deviation)
{
  double gain = 0.;
  for (std::size_t k = 0; k < responses.size(); ++k) {
    const Eigen::VectorXd data = deviation + responses[k].origin();
    const Objective objective(misfit, responses[k], data);
    const double base = objective.at(Eigen::VectorXd::Zero(1)).deviance;
    gain = std::max(gain, base - minimise(objective, bounds(bench, {k}, responses[k])).deviance);
  }
  return gain;
}

} // namespace

Eigen::VectorXd cell_errors(const Workbench &bench)
{
  Eigen::VectorXd variance =
      bench.noise.cell_variance +
      bench.cell_chaos * (1. / static_cast<double>(bench.base().size()) + bench.nuisance_noise);
  variance += bench.nuisance_cells.rowwise().squaredNorm() + bench.tolerance().cwiseAbs2();
  return variance.cwiseSqrt();
}

Evidence evidence_against_base(const Workbench &bench, const std::vector<Response> &responses)
{
  const Fit base = fit_model(bench, {});
  Evidence evidence;
  evidence.distance = base.distance;
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(bench.value.size());
  for (const RunSet &run : bench.base())
    mean += bench.measured(run.values) / static_cast<double>(bench.base().size());
  evidence.cell = (bench.value - mean)
                      .cwiseQuotient(bench.modes.deviations())
                      .cwiseQuotient(cell_errors(bench))
                      .cwiseAbs()
                      .maxCoeff();
  std::vector<Response> in_coordinates;
  for (const Response &response : responses)
    in_coordinates.push_back(response.transformed(bench.misfit.matrix()));
  evidence.gain = largest_gain(bench, bench.misfit, in_coordinates, base.remainder);
  return evidence;
}

Reference make_reference(const Workbench &bench, const std::vector<Response> &responses)
{
  Reference reference;
  reference.chi_square = !bench.options.bootstrap;
  reference.n_modes = static_cast<double>(bench.modes.n_modes());
  reference.n_cells = static_cast<double>(bench.modes.n_cells());
  reference.n_effects = static_cast<double>(responses.size());
  if (reference.chi_square) {
    reference.direction_limit = boost::math::quantile(
        boost::math::complement(boost::math::chi_squared(1.), bench.options.level));
    return reference;
  }

  RandomStream random(bench.options.seed, 1);
  Draw draw(bench);
  std::vector<double> along;
  for (int d = 0; d < n_draws; ++d) {
    draw.make(random);
    std::vector<Response> in_coordinates;
    for (const Response &response : responses) {
      // The base model's noise is in the data's deviation and in each fingerprint alike.
      in_coordinates.push_back(
          response.with_shifted_base(draw.base_shift).transformed(draw.misfit.matrix()));
      const Bounds range = bounds(bench, {in_coordinates.size() - 1}, in_coordinates.back());
      const Eigen::VectorXd end = range.upper(0) > -range.lower(0) ? range.upper : range.lower;
      along.push_back(gain_along(draw.misfit, in_coordinates.back().change(end), draw.deviation,
                                 1. / static_cast<double>(bench.base().size())));
    }
    draw.evidence.gain = largest_gain(bench, draw.misfit, in_coordinates, draw.deviation);
    reference.draws.push_back(draw.evidence);
  }
  reference.tail = fit_tail(reference.draws, reference.n_modes);
  if (!along.empty()) {
    std::sort(along.begin(), along.end());
    const auto place =
        static_cast<std::size_t>((1. - bench.options.level) * static_cast<double>(along.size()));
    reference.direction_limit = along[std::min(place, along.size() - 1)];
  }
  return reference;
}

double Reference::p_distance(const double distance, const double share_of_modes) const
{
  if (chi_square)
    return chi_square_beyond(distance, n_modes * share_of_modes);
  return share_at_least(draws, &Evidence::distance, distance / share_of_modes);
}

double Reference::p_cell(const double deviation) const
{
  if (chi_square)
    return bonferroni(std::erfc(std::abs(deviation) / std::sqrt(2.)), n_cells);
  return share_at_least(draws, &Evidence::cell, std::abs(deviation));
}

double Reference::p_gain(const double gain) const
{
  if (chi_square)
    return bonferroni(chi_square_beyond(gain, 1.), n_effects);
  return share_at_least(draws, &Evidence::gain, gain);
}

double Reference::gain_limit(const double probability) const
{
  if (chi_square)
    return boost::math::quantile(
        boost::math::complement(boost::math::chi_squared(1.), probability / n_effects));
  std::vector<double> gains;
  for (const Evidence &draw : draws)
    gains.push_back(draw.gain);
  std::sort(gains.begin(), gains.end());
  const auto place =
      static_cast<std::size_t>((1. - probability) * static_cast<double>(gains.size()));
  return gains[std::min(place, gains.size() - 1)];
}

double Reference::p_joint(const Evidence &evidence, const bool with_gain) const
{
  const auto least = [&](const Evidence &e) {
    const double p = std::min(p_distance(e.distance), p_cell(e.cell));
    return with_gain ? std::min(p, p_gain(e.gain)) : p;
  };
  const double p = least(evidence);
  if (chi_square)
    return bonferroni(p, with_gain ? 3. : 2.);
  double count = 1.;
  for (const Evidence &draw : draws)
    count += least(draw) <= p ? 1. : 0.;
  return count / (1. + static_cast<double>(draws.size()));
}

} // namespace eunoe::discovery
