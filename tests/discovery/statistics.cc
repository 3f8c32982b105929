// The parts of discovery's statistics against closed formulas.

#include <eunoe/discovery/inference/twins.h>
#include <eunoe/discovery/statistics/covariance.h>
#include <eunoe/discovery/statistics/data_noise.h>
#include <eunoe/discovery/statistics/gaussian_process.h>
#include <eunoe/discovery/statistics/modes.h>

#include "../tests.h"

namespace {

using namespace test;
using namespace eunoe::discovery;

void normal_numbers()
{
  RandomStream a(1, 2), b(1, 2), c(1, 3);
  check("same stream, same numbers", a.normal() == b.normal() && a.normal() != c.normal());
  constexpr int n = 20000;
  const double quantiles[][2] = {
      {0.001, -3.090232306167813}, {0.25, -0.674489750196082}, {0.975, 1.959963984540054}};
  double sum = 0., square = 0.;
  int below[3] = {};
  for (int k = 0; k < n; ++k) {
    const double x = a.normal();
    sum += x / n;
    square += x * x / n;
    for (int q = 0; q < 3; ++q)
      below[q] += x < quantiles[q][1];
  }
  // Five standard errors.
  check("mean and variance",
        std::abs(sum) < 5. / std::sqrt(n) && std::abs(square - 1.) < 5. * std::sqrt(2. / n));
  for (int q = 0; q < 3; ++q) {
    const double p = quantiles[q][0];
    check("quantile", std::abs(below[q] - n * p) < 5. * std::sqrt(n * p * (1. - p)));
  }
}

/// Unit variances, correlation r between neighbours of a block.
Eigen::MatrixXd chain(Eigen::Index n, double r)
{
  Eigen::MatrixXd result(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      result(i, j) = std::pow(r, std::abs(static_cast<double>(i - j)));
  return result;
}

void covariances()
{
  const Eigen::Index n = 30;
  const Eigen::MatrixXd truth = chain(n, 0.8);
  const Eigen::MatrixXd half = Eigen::LLT<Eigen::MatrixXd>(truth).matrixL();
  RandomStream random(3, 1);
  const Eigen::MatrixXd many = centred(random.normals(4000, n) * half.transpose());
  check("covariance from many runs",
        (shrunk_covariance(many, 3999.).matrix - truth).cwiseAbs().maxCoeff() < 0.15);
  const Eigen::MatrixXd few = centred(random.normals(12, n) * half.transpose());
  const Covariance estimate = shrunk_covariance(few, 11.);
  const Eigen::MatrixXd plain = few.transpose() * few / 11.;
  check("shrinkage between none and all", estimate.shrinkage > 0.02 && estimate.shrinkage < 0.9);
  check("fewer runs than cells, still positive",
        (estimate.matrix - 0.01 * Eigen::MatrixXd::Identity(n, n)).llt().info() == Eigen::Success);
  check("closer to the truth than without shrinkage",
        (estimate.matrix - truth).norm() < (plain - truth).norm());
  Eigen::MatrixXd still = few;
  still.col(3).setZero();
  const Eigen::MatrixXd with_still = shrunk_covariance(still, 11.).matrix;
  check("what does not vary has the variance that is believed",
        std::abs(with_still(3, 3) - 1.) < 1e-12 &&
            std::abs(with_still.col(3).cwiseAbs().sum() - 1.) < 1e-12);
  check("variances stay", estimate.matrix.diagonal().isApprox(plain.diagonal(), 1e-12));
  check("determinant of a chain", std::abs(half_log_determinant(truth.llt()) -
                                           0.5 * (n - 1.) * std::log(1. - 0.8 * 0.8)) < 1e-8);
}

/// A base model that runs have told exactly, without nuisances.
BaseInformation known_base(Eigen::Index n_values, double value)
{
  return {Eigen::MatrixXd::Constant(1, n_values, 1e3),
          Eigen::MatrixXd::Constant(1, n_values, 1e3 * value)};
}

GaussianProcess process_of(const std::vector<double> &amplitudes, double power, double factor,
                           double replicates)
{
  std::vector<GaussianProcess::Point> points;
  for (const double u : amplitudes)
    points.push_back({u, Eigen::VectorXd(0),
                      Eigen::VectorXd::Constant(5, 5. + factor * std::pow(u, power)),
                      1. / replicates});
  return {points, known_base(5, 5.)};
}

void gaussian_processes()
{
  const GaussianProcess straight = process_of({0.5, 1., 2.}, 1., 10., 8.);
  check("a straight response is followed", std::abs(straight.predict(1.5).mean(0) - 20.) < 0.5,
        std::to_string(straight.predict(1.5).mean(0)));
  check("the base model at the origin", std::abs(straight.predict(0.).mean(0) - 5.) < 0.05);
  // Runs at one amplitude alone would leave 1/8; their neighbours help.
  const double leverage = straight.predict(1.).leverage(0);
  check("leverage of replicates", leverage > 0.03 && leverage < 0.126, std::to_string(leverage));
  check("far from all runs less is known", straight.predict(8.).leverage(0) > 2. * leverage);

  // Most of an angle of repose comes from the first bit of rolling resistance.
  const GaussianProcess steep = process_of({0.05, 0.2, 1., 2.}, 0.45, 45., 4.);
  for (const double u : {0.05, 0.1, 0.2, 0.5, 1., 2.}) {
    const GaussianProcess::Prediction there = steep.predict(u);
    const double miss = std::abs(there.mean(0) - 5. - 45. * std::pow(u, 0.45));
    check("a steep response is followed", miss < 4. * std::sqrt(there.leverage(0)) + 0.5,
          std::to_string(u) + ": " + std::to_string(miss));
  }
  const GaussianProcess nothing({}, known_base(5, 5.));
  check("an effect without runs changes nothing",
        std::abs(nothing.predict(1.).mean(0) - 5.) < 1e-12);
}

void interactions()
{
  // The effect doubles the influence of a nuisance, which is 1 without it.
  const Eigen::MatrixXd precision = 1e3 * Eigen::MatrixXd::Identity(2, 2);
  BaseInformation base{precision.reshaped().replicate(1, 30), Eigen::MatrixXd(2, 30)};
  base.weighted.row(0).setConstant(5e3);
  base.weighted.row(1).setConstant(1e3);
  std::vector<GaussianProcess::Point> points;
  for (const double u : {0.5, 1., 1., 2.})
    for (const double v : {-1.5, -0.5, 0.5, 1.5})
      points.push_back({u, Eigen::VectorXd::Constant(1, v),
                        Eigen::VectorXd::Constant(30, 5. + 3. * u + v * (1. + u)), 0.1});
  const GaussianProcess process(points, base);
  check("an influence that grows with the effect",
        std::abs(process.predict(1.).gradient(0, 0) - 2.) < 0.3,
        std::to_string(process.predict(1.).gradient(0, 0)));
}

using Points = std::vector<GaussianProcess::Point>;

/// Points of an effect, at nuisances of both signs.
Points points_of(const double slope, RandomStream &random)
{
  Points points;
  for (const double u : {0.1, 0.3, 1., 2.}) {
    const double v = random.normal();
    points.push_back({u, Eigen::VectorXd::Constant(1, v),
                      Eigen::VectorXd::Constant(6, 4. + slope * u + 3. * v) + random.normals(6, 1),
                      0.5});
  }
  return points;
}

/// The base model and each effect by all runs together, beside one normal distribution of all of
/// them.
void shared_base()
{
  RandomStream random(9, 1);
  constexpr double variance = 40.;
  const Eigen::MatrixXd uncertain = Eigen::Vector2d(0.1, 0.4).asDiagonal(),
                        precise = Eigen::Vector2d(10., 2.5).asDiagonal();
  const Eigen::MatrixXd coefficients = Eigen::MatrixXd::Constant(2, 6, 3.5);
  const BaseInformation first{precise.reshaped().replicate(1, 6), precise * coefficients};
  const std::vector<Points> points = {points_of(8., random), points_of(0., random)};
  std::vector<GaussianProcess> processes;
  for (const Points &one : points)
    processes.emplace_back(one, first, std::vector<double>{variance});

  // What is predicted comes last: the base model's terms, and the first effect's outcome and the
  // influence of the nuisance on it.
  constexpr Eigen::Index n = 8, more = 4;
  constexpr double u = 0.6;
  Eigen::MatrixXd terms(n + more, 2), covariance = Eigen::MatrixXd::Zero(n + more, n + more),
                                      values(n, 6);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto &point = points[static_cast<std::size_t>(i / 4)][static_cast<std::size_t>(i % 4)];
    const auto &kernel = processes[static_cast<std::size_t>(i / 4)].kernel();
    terms.row(i) << 1., point.nuisances(0);
    values.row(i) = point.mean.transpose();
    for (Eigen::Index j = 4 * (i / 4); j < 4 * (i / 4) + 4; ++j) {
      const auto &other = points[static_cast<std::size_t>(i / 4)][static_cast<std::size_t>(j % 4)];
      covariance(i, j) = variance * kernel.at(point.amplitude, other.amplitude) *
                             (1. + kernel.interaction * point.nuisances(0) * other.nuisances(0)) +
                         (i == j ? point.variance : 0.);
    }
    if (i >= 4)
      continue;
    const double along = variance * kernel.at(u, point.amplitude);
    covariance(i, n + 2) = covariance(n + 2, i) = along;
    covariance(i, n + 3) = covariance(n + 3, i) = along * kernel.interaction * point.nuisances(0);
  }
  const auto &kernel = processes[0].kernel();
  covariance(n + 2, n + 2) = variance * kernel.at(u, u);
  covariance(n + 3, n + 3) = variance * kernel.at(u, u) * kernel.interaction;
  terms.bottomRows(more) << 1., 0., 0., 1., 1., 0., 0., 1.;
  covariance += terms * uncertain * terms.transpose();
  const Eigen::MatrixXd weights =
      covariance.topLeftCorner(n, n).ldlt().solve(covariance.topRightCorner(n, more)).transpose();
  const Eigen::MatrixXd means =
      terms.bottomRows(more) * coefficients + weights * (values - terms.topRows(n) * coefficients);
  const Eigen::MatrixXd left =
      covariance.bottomRightCorner(more, more) - weights * covariance.topRightCorner(n, more);

  BaseInformation all = first, others = first;
  all += processes[0].about_base();
  all += processes[1].about_base();
  others += processes[1].about_base();
  const LinearBase of_all = all.solve();
  const double variances = of_all.covariance(0, 0) + of_all.covariance(3, 0);
  check("every run tells of the base model",
        (of_all.coefficients - means.topRows(2)).norm() < 1e-8 &&
            std::abs(variances - left(0, 0) - left(1, 1)) < 1e-8);
  processes[0].set_base(others);
  const GaussianProcess::Prediction there = processes[0].predict(u),
                                    nowhere = processes[0].predict(0.);
  check("an effect knows of the base model what other runs say",
        (there.mean - means.row(2).transpose()).norm() < 1e-8 &&
            (there.gradient - means.row(3).transpose()).norm() < 1e-8 &&
            std::abs(there.leverage(0) - left(2, 2) - left(3, 3)) < 1e-8);
  check("and no more, where it is not there",
        (nowhere.mean - means.row(0).transpose()).norm() < 1e-8 &&
            (nowhere.gradient - means.row(1).transpose()).norm() < 1e-8);
}

/// An effect that changes one value of many by much leaves little error in the others.
void few_values_change()
{
  RandomStream random(11, 1);
  std::vector<GaussianProcess::Point> points;
  constexpr Eigen::Index changed = 3, number = 20;
  for (const double u : {0.2, 0.5, 1., 2.}) {
    Eigen::VectorXd mean = random.normals(number, 1) * std::sqrt(0.5);
    mean(changed) += 10. * u;
    points.push_back({u, Eigen::VectorXd(0), mean, 0.5});
  }
  const GaussianProcess process(points, known_base(number, 0.));
  const GaussianProcess::Prediction there = process.predict(1.);
  const double others = (there.leverage.sum() - there.leverage(changed)) / (number - 1.);
  check("the value that changes is followed", std::abs(there.mean(changed) - 10.) < 2.,
        std::to_string(there.mean(changed)));
  check("the others are known well", others < 0.3 * there.leverage(changed),
        std::to_string(others) + ", " + std::to_string(there.leverage(changed)));
  double miss = 0.;
  for (Eigen::Index v = 0; v < number; ++v)
    miss += v == changed ? 0. : there.mean(v) * there.mean(v) / (number - 1.);
  check("as well as they think", miss < 4. * others && miss > 0.05 * others, std::to_string(miss));
}

void tails()
{
  RandomStream random(8, 1);
  Eigen::ArrayXd draws(4000);
  for (double &draw : draws)
    draw = -std::log(random.uniform());
  const Tail tail(draws);
  check("p within the draws", std::abs(tail.p(1.) - std::exp(-1.)) < 0.03);
  // An exponential tail goes on as it began, beyond all draws.
  check("p beyond the draws", std::abs(std::log(tail.p(15.)) + 15.) < 1.5,
        std::to_string(tail.p(15.)));
  check("quantile", std::abs(tail.p(tail.quantile(0.05)) - 0.05) < 1e-6);
}

void modes_and_noise()
{
  std::vector<DataPoint> points;
  for (int k = 0; k < 20; ++k)
    points.push_back({"e", "profile", 19 - k});
  points.push_back({"e", "angle", 0});
  const Modes modes(points, Eigen::VectorXd::Constant(21, 2.));
  check("number of modes", modes.n_modes() == Modes::most_modes + 1);
  check("orthonormal", (modes.basis() * modes.basis().transpose() -
                        Eigen::MatrixXd::Identity(modes.n_modes(), modes.n_modes()))
                               .cwiseAbs()
                               .maxCoeff() < 1e-12);

  // The instrument adds as much variance as the scatter has.
  const Eigen::MatrixXd replicate_covariance =
      Eigen::MatrixXd::Identity(modes.n_modes(), modes.n_modes());
  const auto mean_of = [](const InstrumentNoise &noise, const std::size_t group) {
    constexpr int number = 200;
    double sum = 0.;
    for (int k = 0; k < number; ++k)
      sum += noise.at((k + 0.5) / number)[group].mean() / number;
    return sum;
  };
  const InstrumentNoise profile(modes, replicate_covariance,
                                Eigen::VectorXd::Constant(21, std::sqrt(2.)),
                                Eigen::VectorXd::Constant(21, 40.));
  const double expected = mean_of(profile, 1);
  check("noise of the instrument", std::abs(expected - 1.) < 0.15, std::to_string(expected));
  check("a higher level is more noise", profile.at(0.1)[1].mean() < profile.at(0.9)[1].mean());
  RandomStream random(4, 4);
  double mean = 0.;
  for (int k = 0; k < 4000; ++k)
    mean += profile.at(random.uniform())[1].draw(random) / 4000.;
  check("draws of it", std::abs(mean - expected) < 0.03, std::to_string(mean));

  // Few repeats that scatter like runs leave less noise than the scatter of their variance.
  const InstrumentNoise few(modes, replicate_covariance, Eigen::VectorXd::Ones(21),
                            Eigen::VectorXd::Constant(21, 4.));
  check("little noise", mean_of(few, 1) < 0.25, std::to_string(mean_of(few, 1)));

  // An angle that hardly varies between runs says nothing about the profile's noise.
  Eigen::VectorXd deviation = Eigen::VectorXd::Ones(21);
  deviation(20) = 100.;
  const InstrumentNoise uneven(modes, replicate_covariance, deviation,
                               Eigen::VectorXd::Constant(21, 5.));
  const double of_angle = mean_of(uneven, 0), of_profile = mean_of(uneven, 1);
  check("one observable without chaos", of_profile < 0.2 && of_angle > 5e3 && of_angle < 4e4,
        std::to_string(of_angle) + ", " + std::to_string(of_profile));
  const InstrumentNoise declared(modes, replicate_covariance, deviation, Eigen::VectorXd::Ones(21));
  check("declared deviations are believed", std::abs(declared.at(0.5)[0].mean() - 9999.) < 1e-6);
  constexpr double coarse = 1e12;
  const double mean_of_coarse = ExcessVariance(coarse, 10., coarse).mean();
  check("an instrument far coarser than the runs scatter",
        mean_of_coarse > 0.5 * coarse && mean_of_coarse < 3. * coarse,
        std::to_string(mean_of_coarse));
}

} // namespace

EUNOE_TEST()
{
  normal_numbers();
  covariances();
  gaussian_processes();
  interactions();
  shared_base();
  few_values_change();
  tails();
  modes_and_noise();
}
