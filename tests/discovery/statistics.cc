// The parts of discovery's statistics against closed formulas.

#include <eunoe/discovery/statistics/covariance.h>
#include <eunoe/discovery/statistics/data_noise.h>
#include <eunoe/discovery/statistics/emulator.h>
#include <eunoe/discovery/statistics/misfit.h>
#include <eunoe/discovery/statistics/modes.h>

#include "synthetic.h"

namespace {

using namespace test;

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
  const std::vector<int> one(n, 0);
  const Eigen::MatrixXd many = centred(random.normals(4000, n) * half.transpose());
  check("covariance from many runs",
        (shrunk_covariance(many, 3999., one).matrix - truth).cwiseAbs().maxCoeff() < 0.15);
  const Eigen::MatrixXd few = centred(random.normals(12, n) * half.transpose());
  const Covariance estimate = shrunk_covariance(few, 11., one);
  const Eigen::MatrixXd plain = few.transpose() * few / 11.;
  check("shrinkage between none and all", estimate.shrinkage > 0.02 && estimate.shrinkage < 0.9);
  check("fewer runs than cells, still positive",
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(estimate.matrix).eigenvalues()(0) > 0.01);
  check("closer to the truth than without shrinkage",
        (estimate.matrix - truth).norm() < (plain - truth).norm());
  std::vector<int> two(n, 0);
  std::fill(two.begin() + 15, two.end(), 1);
  check("experiments are uncorrelated",
        shrunk_covariance(few, 11., two).matrix.topRightCorner(15, 15).norm() == 0.);
}

void misfits()
{
  const Eigen::MatrixXd replicate_covariance = chain(8, 0.6), other = 0.3 * chain(8, 0.1);
  const Misfit misfit(replicate_covariance, other);
  RandomStream random(5, 1);
  const Eigen::VectorXd d = random.normals(8, 1);
  const double h = 0.2;
  const Eigen::MatrixXd sum = other + h * replicate_covariance;
  check("Mahalanobis distance",
        std::abs(misfit.distance(misfit.coordinates(d), h) - d.dot(sum.inverse() * d)) < 1e-9);
  check("log determinant",
        std::abs(misfit.log_determinant(h) - misfit.log_determinant(0.5) -
                 std::log(sum.determinant()) +
                 std::log((other + 0.5 * replicate_covariance).determinant())) < 1e-9);
  // With many degrees of freedom the deviance is that of a normal distribution.
  check("deviance", std::abs(misfit.deviance(12., 1.5) - 13.5) < 1e-5);
}

Slopes same_slopes(const double square)
{
  return {Eigen::VectorXd::Constant(1, square), Eigen::VectorXd::Constant(1, square)};
}

void emulators()
{
  // A straight response with exact values, at 0, 1 and 2, and replicates.
  const Eigen::VectorXd origin = Eigen::VectorXd::Constant(3, 5.);
  const Eigen::VectorXd slope = Eigen::VectorXd::LinSpaced(3, 1., 3.);
  std::vector<Emulator::Run> runs;
  for (const auto &[u, count] : {std::pair<double, int>(0., 10), {1., 4}, {2., 4}})
    for (int k = 0; k < count; ++k)
      runs.push_back({Eigen::VectorXd::Constant(1, u), origin + u * slope, 1.});
  const Emulator emulator(runs, same_slopes(1e12));
  const Eigen::VectorXd at = Eigen::VectorXd::Constant(1, 1.3);
  check("origin", (emulator.origin() - origin).norm() < 1e-6);
  check("change", (emulator.change(at) - 1.3 * slope).norm() < 1e-6);
  // Three levels and three terms: the mean at each level depends on its own runs only.
  check("leverage of replicates",
        std::abs(emulator.leverage(Eigen::VectorXd::Ones(1)) - 0.25) < 1e-6 &&
            std::abs(emulator.leverage(Eigen::VectorXd::Zero(1)) - 0.1) < 1e-6);
  check("range of amplitudes", emulator.upper(0) == 3. && emulator.lower(0) == 0.);
}

/// Runs at 0 and at some amplitudes, whose values grow more and more slowly.
constexpr double power = 0.75;
std::vector<Emulator::Run> saturating(const std::vector<double> &amplitudes)
{
  std::vector<Emulator::Run> runs;
  const auto add = [&](double u, int count) {
    for (int k = 0; k < count; ++k)
      runs.push_back({Eigen::VectorXd::Constant(1, u),
                      Eigen::VectorXd::Constant(2, 100. * std::pow(u, power)), 1.});
  };
  add(0., 10);
  for (const double u : amplitudes)
    add(u, 8);
  return runs;
}

void bent_responses()
{
  // The square of the mean slope between 0 and 1.
  const Slopes slope = same_slopes(100. * 100.);
  const Eigen::VectorXd small = Eigen::VectorXd::Constant(1, 0.04);
  const Emulator far(saturating({1., 2.}), slope), near(saturating({0.04, 1., 2.}), slope);
  const double truth = 100. * std::pow(0.04, power);
  const double miss = std::abs(far.change(small)(0) - truth);
  check("what bends before the first amplitude is missed", miss > 2.);
  check("and known to be doubtful", far.leverage(small) > std::pow(0.5 * miss, 2),
        std::to_string(miss) + ", " + std::to_string(far.leverage(small)));
  check("runs there mend it", std::abs(near.change(small)(0) - truth) < 1.,
        std::to_string(near.change(small)(0)));
  check("and are trusted", near.leverage(small) < 0.5);
}

/// A tenth of the values respond, most of it at small amplitudes: an angle of repose to rolling
/// resistance.
void steep_responses()
{
  const auto value = [](double u) { return 45. * std::pow(u, 0.45); };
  std::vector<Emulator::Run> runs;
  for (const auto &[u, count] :
       {std::pair<double, int>(0., 30), {0.22, 8}, {0.25, 16}, {0.3, 8}, {1., 2}, {2., 2}})
    for (int k = 0; k < count; ++k) {
      Eigen::VectorXd values = Eigen::VectorXd::Zero(10);
      values(0) = value(u);
      runs.push_back({Eigen::VectorXd::Constant(1, u), values, 1.});
    }
  const auto mean_square = [&](double u) {
    return Eigen::VectorXd::Constant(1, std::pow(value(u) / u, 2) / 10.);
  };
  const Emulator emulator(runs, {mean_square(1.5), mean_square(0.22)});
  for (const double u : {0.22, 0.25, 0.3, 1., 2.}) {
    const double miss = emulator.change(Eigen::VectorXd::Constant(1, u))(0) - value(u);
    check("follows the runs that are there", std::abs(miss) < 0.5, std::to_string(miss));
  }
  check("what bends is not seen before them",
        emulator.unseen_bends(Eigen::VectorXd::Constant(1, 0.2))(0) > 0. &&
            emulator.unseen_bends(Eigen::VectorXd::Constant(1, 0.22))(0) == 0.);
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
  const DataNoise noise = estimate_data_noise(
      modes, replicate_covariance, Eigen::VectorXd::Ones(21),
      {Eigen::VectorXd::Constant(21, std::sqrt(2.)), Eigen::VectorXd::Constant(21, 40.)});
  check("noise of the instrument", std::abs(noise.point_variance(0) - 2. / 40.) < 0.05 * 2. / 40. &&
                                       std::abs(noise.modes(0, 0) - 2. / 40.) < 0.05 * 2. / 40.);

  // An angle that hardly varies between runs says nothing about the profile's noise.
  Eigen::VectorXd deviation = Eigen::VectorXd::Ones(21);
  deviation(20) = 100.;
  const DataNoise uneven =
      estimate_data_noise(modes, replicate_covariance, Eigen::VectorXd::Ones(21),
                          {deviation, Eigen::VectorXd::Constant(21, 5.)});
  check("one observable without chaos",
        std::abs(uneven.point_variance(0) - 1. / 5.) < 0.05 / 5. &&
            std::abs(uneven.point_variance(20) - 1e4 / 5.) < 0.05 * 1e4 / 5.);
}

} // namespace

EUNOE_TEST()
{
  normal_numbers();
  covariances();
  misfits();
  emulators();
  bent_responses();
  steep_responses();
  modes_and_noise();
}
