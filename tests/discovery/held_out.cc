// The test of a model by held-out data: significant as often as its level says if the model is
// true, whatever its uncertainties, and always if the model is wrong.

#include <eunoe/discovery/stages/held_out.h>
#include <eunoe/discovery/statistics/covariance.h>

#include "synthetic.h"

namespace {

using namespace test;

constexpr Eigen::Index n_points = 10;
constexpr unsigned int n_repeats = 4;

/// The uncertainties of a model, and its error.
struct Setting
{
  double shift = 0.;       ///< of every data point from the model, in units of one run's scatter
  double uncertainty = 0.; ///< standard deviation of a nuisance that changes all data points alike
  double instrument = 0.;  ///< variance of the measurement's noise beside a run's
  bool has_other = false;  ///< whether another model was run, too
};

/// Held-out data of a model, from runs whose data points are correlated.
double p_of(const Setting &setting, std::uint32_t seed)
{
  RandomStream random(seed, 11);
  Eigen::MatrixXd chaos(n_points, n_points);
  for (Eigen::Index i = 0; i < n_points; ++i)
    for (Eigen::Index j = 0; j < n_points; ++j)
      chaos(i, j) = std::pow(0.5, std::abs(static_cast<double>(i - j)));
  const Eigen::MatrixXd half = Eigen::LLT<Eigen::MatrixXd>(chaos).matrixL();
  const auto runs = [&](Eigen::Index n) -> Eigen::MatrixXd {
    return random.normals(n, n_points) * half.transpose();
  };
  HeldOut held_out;
  for (int c = 0; c < n_points; ++c)
    held_out.points.push_back({{"e", "profile", c}, 0., 1., n_repeats});
  const Eigen::MatrixXd measured =
      runs(n_repeats) + std::sqrt(setting.instrument) * random.normals(n_repeats, n_points);
  held_out.data = measured.colwise().mean().transpose().array() + setting.shift +
                  setting.uncertainty * random.normal();
  held_out.deviation =
      (centred(measured).colwise().squaredNorm().transpose() / (n_repeats - 1.)).cwiseSqrt();
  held_out.repeats = Eigen::VectorXd::Constant(n_points, n_repeats);
  held_out.before = runs(8);
  if (setting.has_other)
    held_out.after = runs(8).array() + 5.;
  Prediction prediction;
  prediction.runs = held_out.before;
  prediction.mean = prediction.runs.colwise().mean().transpose();
  prediction.uncertainty = Eigen::MatrixXd::Constant(n_points, 1, setting.uncertainty);
  prediction.leverage = 1. / 8.;
  return p_of_held_out(held_out, prediction, seed);
}

/// Share of studies in which the test is significant at a level.
double share_below(double level, const Setting &setting, std::uint32_t first_seed, int number)
{
  int below = 0;
  for (int k = 0; k < number; ++k)
    below += p_of(setting, first_seed + static_cast<std::uint32_t>(k)) <= level;
  return below / static_cast<double>(number);
}

/// A tenth of the studies must be significant at 0.1, within four standard errors.
void check_level(const std::string &name, const Setting &setting, std::uint32_t first_seed)
{
  constexpr int number = 150;
  const double share = share_below(0.1, setting, first_seed, number);
  check(name, std::abs(share - 0.1) < 4. * std::sqrt(0.1 * 0.9 / number),
        std::to_string(share) + " of the studies are significant at 0.1");
}

} // namespace

EUNOE_TEST()
{
  check_level("a true model", {}, 1);
  check_level("with what another model's runs tell of the chaos", {0., 0., 0., true}, 1000);
  check_level("with a nuisance that is not known", {0., 3., 0., false}, 2000);
  check_level("with noise of the instrument", {0., 0., 2., false}, 3000);

  const double wrong = share_below(0.05, {2., 0., 0., false}, 4000, 40);
  check("a wrong model is seen", wrong >= 0.9, std::to_string(wrong));
  const double unknown = share_below(0.05, {2., 3., 0., false}, 5000, 40);
  check("unless a nuisance may do the same", unknown <= 0.3, std::to_string(unknown));
}
