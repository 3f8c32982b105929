#include <eunoe/discovery/stages/places.h>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

Amplitudes near_amplitudes(const Workbench &bench, const EffectSet &set,
                           const Eigen::VectorXd &position)
{
  constexpr double nearness = 0.15;
  const Amplitudes wanted = bench.amplitudes(set, position);
  Amplitudes result = wanted;
  double least = nearness;
  for (const auto &[amplitudes, sets] : bench.runs) {
    if (wanted.empty() || amplitudes.size() != wanted.size() || sets.empty())
      continue;
    double apart = 0.;
    for (const std::size_t k : set) {
      const Factor &effect = bench.effects[k];
      const auto there = amplitudes.find(effect.name), here = wanted.find(effect.name);
      if (here != wanted.end())
        apart = std::max(apart, there == amplitudes.end()
                                    ? 2. * nearness
                                    : std::abs((there->second - here->second) /
                                               (here->second - effect.null_value)));
    }
    if (apart <= least) {
      least = apart;
      result = amplitudes;
    }
  }
  return result;
}

namespace {

/// One effect of a fit without the others.
Eigen::VectorXd alone(const Fit &fit, const Eigen::Index effect)
{
  Eigen::VectorXd result = Eigen::VectorXd::Zero(fit.position.size());
  result(effect) = fit.position(effect);
  return result;
}

/// Square by which the change of one effect of a fit may differ from what is foreseen, as it bends
/// unseen. What of the change noise explains does not count.
double unseen_square(const Workbench &bench, const Fit &fit, const Response &response,
                     const Eigen::Index effect)
{
  const Eigen::VectorXd position = alone(fit, effect);
  const double noise =
      response.change_leverage(position) * static_cast<double>(bench.misfit.size());
  return response.unseen_bends(position)(effect) *
         std::max(0., response.change(position).squaredNorm() - noise);
}

/// Whether that matters beside the variance of the data along the effect's change.
bool may_bend(const Workbench &bench, const Fit &fit, const Response &response,
              const Eigen::Index effect)
{
  constexpr double negligible = 0.25;
  const Eigen::VectorXd squares = response.change(alone(fit, effect)).cwiseAbs2();
  return unseen_square(bench, fit, response, effect) * squares.sum() >
         negligible * squares.dot(bench.misfit.variance(fit.leverage));
}

} // namespace

Eigen::VectorXd place_of_runs(const Workbench &bench, const Fit &fit)
{
  const Response response = bench.response(fit.effects);
  Eigen::VectorXd place = fit.position;
  for (Eigen::Index k = 0; k < place.size(); ++k)
    if (may_bend(bench, fit, response, k))
      place(k) *= 0.5;
  return place;
}

double hoped_distance(const Workbench &bench, const Fit &fit)
{
  const Response response = bench.response(fit.effects);
  double square = 0.;
  for (Eigen::Index k = 0; k < fit.position.size(); ++k)
    square += unseen_square(bench, fit, response, k);
  return bench.misfit.distance(fit.remainder,
                               fit.leverage + square / static_cast<double>(bench.misfit.size()));
}

} // namespace eunoe::discovery
