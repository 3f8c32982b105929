// The scatter of an emulator is that of the base model, whatever strong effects do to single
// observables.

#include <eunoe/discovery/inference/emulator.h>
#include <eunoe/discovery/statistics/random_stream.h>

#include "../tests.h"

#include <cmath>

namespace {

using namespace eunoe::discovery;
using test::check;

constexpr Eigen::Index n_points = 5, force = 4;

/// Runs of an effect that moves all observables alike, and makes one of them, a force, scatter
/// twenty times as much where it is strong.
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
            10. * amplitude + random.normal() * (c == force && amplitude >= 1. ? 20. : 1.);
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
  check("a strong effect scatters more, as a whole", emulator.scatter({{0, 4.}}) > 2.,
        std::to_string(emulator.scatter({{0, 4.}})));
}
