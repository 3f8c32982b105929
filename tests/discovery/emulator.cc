// The scatter of an emulator is that of the base model, whatever strong effects do to single
// observables; what they do to these is told for each.

#include <eunoe/discovery/inference/emulator.h>
#include <eunoe/discovery/statistics/random_stream.h>

#include "../tests.h"

#include <cmath>

namespace {

using namespace eunoe::discovery;
using test::check;

constexpr Eigen::Index n_points = 5, force = 4;

/// Runs of an effect that moves all observables alike; the change of one of them, a force, differs
/// from run to run by half of itself, so that it scatters twenty times as much at the end.
std::vector<Sample> runs(RandomStream &random)
{
  std::vector<Sample> samples;
  const auto add = [&](const double amplitude, const int number) {
    for (int k = 0; k < number; ++k) {
      Sample sample;
      sample.position = Eigen::VectorXd::Constant(1, amplitude);
      sample.values.resize(n_points);
      for (Eigen::Index c = 0; c < n_points; ++c)
        sample.values(c) =
            10. * amplitude + random.normal() * (c == force ? std::hypot(1., 5. * amplitude) : 1.);
      samples.push_back(sample);
    }
  };
  add(0., 40);
  for (const double amplitude : {0.01, 0.03, 0.1})
    add(amplitude, 10);
  for (const double amplitude : {1., 2., 4.})
    add(amplitude, 20);
  return samples;
}

} // namespace

EUNOE_MPI_TEST()
{
  Factor effect;
  effect.name = "effect";
  effect.upper = 4.;
  const FactorSpace space({effect});
  std::vector<DataPoint> points;
  std::vector<Eigen::Index> columns;
  for (Eigen::Index c = 0; c < n_points; ++c) {
    points.push_back({"heap", "observable " + std::to_string(c), 0});
    columns.push_back(c);
  }
  RandomStream random(1, 1);
  const ExperimentEmulator emulator(space, runs(random), columns, points,
                                    Eigen::VectorXd::Constant(n_points, 1e-3));

  const Eigen::MatrixXd &rows = emulator.deviations();
  check("deviations are those of runs without a strong effect", rows.rows() == 40 + 3 * 10,
        std::to_string(rows.rows()));
  check("and have no heavy tails", rows.cwiseAbs().maxCoeff() < 5.,
        std::to_string(rows.cwiseAbs().maxCoeff()));
  const Eigen::VectorXd deviation = emulator.mode_covariance().diagonal().cwiseSqrt();
  check("the scatter of each observable is the base model's",
        (deviation.array() > 0.75).all() && (deviation.array() < 1.3).all(),
        std::to_string(deviation.minCoeff()) + " to " + std::to_string(deviation.maxCoeff()));

  const ExperimentEmulator::Prediction strong = emulator.predict({{0, 4.}}),
                                       weak = emulator.predict({{0, 0.1}});
  const Eigen::VectorXd growth = emulator.growth(strong.scatter).cwiseSqrt();
  check("the force scatters twenty times as much with a strong effect",
        growth(force) > 14. && growth(force) < 28., std::to_string(growth(force)));
  check("the others do not", growth.head(force).maxCoeff() < 4.,
        std::to_string(growth.head(force).maxCoeff()));
  check("a weak effect scatters as the base model does",
        emulator.growth(weak.scatter).maxCoeff() < 2.,
        std::to_string(emulator.growth(weak.scatter).maxCoeff()));
  check("the mean of the force is known the less",
        strong.outcome.leverage(force) > 10. * strong.outcome.leverage(0),
        std::to_string(strong.outcome.leverage(force) / strong.outcome.leverage(0)));
  check("replicates that scatter less than the base model do not make it scatter less",
        weak.common >= 1., std::to_string(weak.common));
}
