#include <eunoe/discovery/stages/models.h>
#include <eunoe/discovery/stages/null_distribution.h>
#include <eunoe/discovery/statistics/random_stream.h>

#include <boost/math/distributions/chi_squared.hpp>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

namespace {

constexpr int n_draws = 499;

double share_at_least(const std::vector<TestStatistics> &draws, double TestStatistics::*member,
                      const double value)
{
  const auto count = std::count_if(draws.begin(), draws.end(), [&](const TestStatistics &draw) {
    return draw.*member >= value;
  });
  return (1. + static_cast<double>(count)) / (1. + static_cast<double>(draws.size()));
}

double chi_square_beyond(const double value, const double degrees_of_freedom)
{
  if (value <= 0.)
    return 1.;
  return boost::math::cdf(
      boost::math::complement(boost::math::chi_squared(degrees_of_freedom), value));
}

/// p-value of the smallest of n independent p-values.
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

/// Fits the F distribution of Misfit::Tail to the mean and variance of the drawn distances.
Misfit::Tail fit_tail(const std::vector<TestStatistics> &draws, const double n)
{
  double mean = 0., square = 0.;
  for (const TestStatistics &draw : draws) {
    mean += draw.distance / static_cast<double>(draws.size());
    square += draw.distance * draw.distance / static_cast<double>(draws.size());
  }
  const double spread = (square - mean * mean) / (mean * mean), x = 0.5 * spread * n;
  Misfit::Tail tail;
  tail.degrees_of_freedom = x > 1.001 ? std::clamp((4. * x + n - 2.) / (x - 1.), 6., 1e6) : 1e6;
  tail.inflation = mean / n * (tail.degrees_of_freedom - 2.) / tail.degrees_of_freedom;
  return tail;
}

/// A simulated study in which nothing is missing.
class NullDraw
{
public:
  explicit NullDraw(const StudyState &study)
      : study(study),
        lower(Eigen::LLT<Eigen::MatrixXd>(study.replicate_covariance.unshrunk).matrixL()),
        most_repeats(static_cast<Eigen::Index>(study.repeats.maxCoeff())),
        fine((1. - (study.modes.basis().transpose() * study.replicate_covariance.matrix *
                    study.modes.basis())
                       .diagonal()
                       .array())
                 .max(0.)
                 .sqrt())
  {
  }

  void make(RandomStream &random)
  {
    const Eigen::MatrixXd base = runs(static_cast<Eigen::Index>(study.base().size()), random);
    const Eigen::Index n = study.modes.n_points();
    // Runs of other models, of which only deviations from their means are used.
    const auto others =
        static_cast<Eigen::Index>(study.replicate_degrees_of_freedom + 0.5) - (base.rows() - 1);
    Eigen::MatrixXd deviations(base.rows() + others, study.modes.n_modes());
    deviations << centred(base * study.modes.basis().transpose()),
        random.normals(others, lower.rows()) * lower.transpose();
    const Covariance replicate_covariance = shrunk_covariance(
        deviations, study.replicate_degrees_of_freedom, study.modes.experiment_of_mode());
    const Eigen::VectorXd replicate_variance =
        (centred(base).colwise().squaredNorm().transpose() / static_cast<double>(base.rows() - 1))
            .cwiseMax(1e-6);
    Repeats repeats{Eigen::VectorXd(n), study.repeats};
    const Eigen::VectorXd data = measure(random, repeats);
    const DataNoise noise =
        estimate_data_noise(study.modes, replicate_covariance.matrix, replicate_variance, repeats);
    const Eigen::VectorXd points = data - base.colwise().mean().transpose();
    const double leverage = 1. / static_cast<double>(base.rows());
    misfit = Misfit(replicate_covariance.matrix,
                    study.other_covariance(noise, replicate_covariance.matrix));
    misfit.tail = study.misfit.tail;
    deviation = misfit.coordinates(study.modes.basis() * points);
    base_shift = study.modes.basis() * base.colwise().mean().transpose();
    statistics = {};
    statistics.distance = misfit.distance(deviation, leverage);
    Eigen::VectorXd variance =
        noise.point_variance + (leverage + study.nuisance_noise) * replicate_variance;
    variance += study.nuisance_changes.rowwise().squaredNorm() + study.tolerance().cwiseAbs2();
    statistics.largest_deviation = (points.array() / variance.array().sqrt()).abs().maxCoeff();
  }

  Misfit misfit;
  Eigen::VectorXd deviation;  ///< data less base model, in coordinates of the misfit
  Eigen::VectorXd base_shift; ///< of the base model's mean, in modes
  TestStatistics statistics;

private:
  /// Draws replicates: values at all data points, in units of the deviation between replicates.
  Eigen::MatrixXd runs(const Eigen::Index number, RandomStream &random) const
  {
    Eigen::MatrixXd points =
        random.normals(number, lower.rows()) * lower.transpose() * study.modes.basis();
    // What the modes leave out, the finest waves of long profiles.
    if (fine.maxCoeff() > 1e-3)
      points += random.normals(number, points.cols()) * fine.matrix().asDiagonal();
    return points;
  }

  Eigen::VectorXd measure(RandomStream &random, Repeats &repeats) const
  {
    const Eigen::Index n = study.modes.n_points();
    const Eigen::VectorXd &ratio = study.noise.ratio;
    Eigen::MatrixXd rows = runs(most_repeats, random) * ratio.cwiseMin(1.).cwiseSqrt().asDiagonal();
    rows +=
        random.normals(most_repeats, n) * (ratio.array() - 1.).max(0.).sqrt().matrix().asDiagonal();
    const Eigen::VectorXd jitter =
        random.normals(1, study.nuisance_changes.cols()).row(0).transpose();
    Eigen::VectorXd mean = study.nuisance_changes * jitter;
    mean += std::sqrt(study.nuisance_noise) * runs(1, random).row(0).transpose();
    const Eigen::VectorXd tolerance = study.tolerance() * std::sqrt(0.5);
    for (const Modes::Group &group : study.modes.groups()) {
      const double common = random.normal();
      for (const Eigen::Index c : group.points) {
        const auto number = static_cast<Eigen::Index>(study.repeats(c));
        const Eigen::VectorXd column = rows.col(c).head(number);
        mean(c) += column.mean() + tolerance(c) * (common + random.normal());
        repeats.deviation(c) = number > 1
                                   ? std::sqrt((column.array() - column.mean()).square().sum() /
                                               static_cast<double>(number - 1))
                                   : study.deviation(c) / study.modes.deviations()(c);
      }
    }
    return mean;
  }

  const StudyState &study;
  const Eigen::MatrixXd lower;
  const Eigen::Index most_repeats;
  const Eigen::ArrayXd fine;
};

/// Largest fall of deviance that one effect brings.
double largest_gain(const StudyState &study, const Misfit &misfit,
                    const std::vector<Emulator> &emulators, const Eigen::VectorXd &deviation)
{
  double gain = 0.;
  for (std::size_t k = 0; k < emulators.size(); ++k) {
    const Eigen::VectorXd data = deviation + emulators[k].origin();
    const Objective objective(misfit, emulators[k], data);
    const double base = objective.at(Eigen::VectorXd::Zero(1)).deviance;
    gain = std::max(gain, base - minimise(objective, bounds(study, {k}, emulators[k])).deviance);
  }
  return gain;
}

} // namespace

Eigen::VectorXd standard_errors(const StudyState &study)
{
  Eigen::VectorXd variance =
      study.noise.point_variance +
      study.replicate_variance *
          (1. / static_cast<double>(study.base().size()) + study.nuisance_noise);
  variance += study.nuisance_changes.rowwise().squaredNorm() + study.tolerance().cwiseAbs2();
  return variance.cwiseSqrt();
}

TestStatistics test_statistics(const StudyState &study, const std::vector<Emulator> &emulators)
{
  const Fit base = fit_model(study, {});
  TestStatistics statistics;
  statistics.distance = base.distance;
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(study.value.size());
  for (const Replicate &run : study.base())
    mean += study.measured(run.values) / static_cast<double>(study.base().size());
  statistics.largest_deviation = (study.value - mean)
                                     .cwiseQuotient(study.modes.deviations())
                                     .cwiseQuotient(standard_errors(study))
                                     .cwiseAbs()
                                     .maxCoeff();
  std::vector<Emulator> in_coordinates;
  for (const Emulator &emulator : emulators)
    in_coordinates.push_back(emulator.transformed(study.misfit.matrix()));
  statistics.gain = largest_gain(study, study.misfit, in_coordinates, base.remainder);
  return statistics;
}

NullDistribution make_null_distribution(const StudyState &study,
                                        const std::vector<Emulator> &emulators)
{
  NullDistribution null_distribution;
  null_distribution.chi_square = !study.options.bootstrap;
  null_distribution.n_modes = static_cast<double>(study.modes.n_modes());
  null_distribution.n_points = static_cast<double>(study.modes.n_points());
  null_distribution.n_effects = static_cast<double>(emulators.size());
  if (null_distribution.chi_square) {
    null_distribution.direction_limit = boost::math::quantile(
        boost::math::complement(boost::math::chi_squared(1.), study.options.level));
    return null_distribution;
  }

  RandomStream random(study.options.seed, 1);
  NullDraw draw(study);
  std::vector<double> along;
  for (int d = 0; d < n_draws; ++d) {
    draw.make(random);
    std::vector<Emulator> in_coordinates;
    for (const Emulator &emulator : emulators) {
      // The base model's noise is in the data's deviation and in each fingerprint alike.
      in_coordinates.push_back(
          emulator.with_shifted_base(draw.base_shift).transformed(draw.misfit.matrix()));
      const Bounds range = bounds(study, {in_coordinates.size() - 1}, in_coordinates.back());
      const Eigen::VectorXd end = range.upper(0) > -range.lower(0) ? range.upper : range.lower;
      along.push_back(gain_along(draw.misfit, in_coordinates.back().change(end), draw.deviation,
                                 1. / static_cast<double>(study.base().size())));
    }
    draw.statistics.gain = largest_gain(study, draw.misfit, in_coordinates, draw.deviation);
    null_distribution.draws.push_back(draw.statistics);
  }
  null_distribution.tail = fit_tail(null_distribution.draws, null_distribution.n_modes);
  if (!along.empty()) {
    std::sort(along.begin(), along.end());
    const auto place =
        static_cast<std::size_t>((1. - study.options.level) * static_cast<double>(along.size()));
    null_distribution.direction_limit = along[std::min(place, along.size() - 1)];
  }
  return null_distribution;
}

double NullDistribution::p_distance(const double distance, const double share_of_modes) const
{
  if (chi_square)
    return chi_square_beyond(distance, n_modes * share_of_modes);
  return share_at_least(draws, &TestStatistics::distance, distance / share_of_modes);
}

double NullDistribution::p_largest_deviation(const double deviation) const
{
  if (chi_square)
    return bonferroni(std::erfc(std::abs(deviation) / std::sqrt(2.)), n_points);
  return share_at_least(draws, &TestStatistics::largest_deviation, std::abs(deviation));
}

double NullDistribution::p_gain(const double gain) const
{
  if (chi_square)
    return bonferroni(chi_square_beyond(gain, 1.), n_effects);
  return share_at_least(draws, &TestStatistics::gain, gain);
}

double NullDistribution::gain_limit(const double probability) const
{
  if (chi_square)
    return boost::math::quantile(
        boost::math::complement(boost::math::chi_squared(1.), probability / n_effects));
  std::vector<double> gains;
  for (const TestStatistics &draw : draws)
    gains.push_back(draw.gain);
  std::sort(gains.begin(), gains.end());
  const auto place =
      static_cast<std::size_t>((1. - probability) * static_cast<double>(gains.size()));
  return gains[std::min(place, gains.size() - 1)];
}

double NullDistribution::p_joint(const TestStatistics &statistics, const bool with_gain) const
{
  const auto least = [&](const TestStatistics &e) {
    const double p = std::min(p_distance(e.distance), p_largest_deviation(e.largest_deviation));
    return with_gain ? std::min(p, p_gain(e.gain)) : p;
  };
  const double p = least(statistics);
  if (chi_square)
    return bonferroni(p, with_gain ? 3. : 2.);
  double count = 1.;
  for (const TestStatistics &draw : draws)
    count += least(draw) <= p ? 1. : 0.;
  return count / (1. + static_cast<double>(draws.size()));
}

} // namespace eunoe::discovery
