#include <eunoe/discovery/stages/design.h>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

Amplitudes nearest_design_point(const StudyState &study, const EffectSet &set,
                                const Eigen::VectorXd &position)
{
  constexpr double nearness = 0.15;
  const Amplitudes wanted = study.amplitudes(set, position);
  Amplitudes result = wanted;
  double least = nearness;
  for (const auto &[amplitudes, sets] : study.replicates) {
    if (wanted.empty() || amplitudes.size() != wanted.size() || sets.empty())
      continue;
    double apart = 0.;
    for (const std::size_t k : set) {
      const Factor &effect = study.effects[k];
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

/// Position of one effect of a fit, with all others at their null values.
Eigen::VectorXd alone(const Fit &fit, const Eigen::Index effect)
{
  Eigen::VectorXd result = Eigen::VectorXd::Zero(fit.position.size());
  result(effect) = fit.position(effect);
  return result;
}

/// Mean square by which nonlinearity that no run has shown may alter the predicted change of one
/// effect. The part of the change that noise explains does not count.
double unseen_square(const StudyState &study, const Fit &fit, const Emulator &emulator,
                     const Eigen::Index effect)
{
  const Eigen::VectorXd position = alone(fit, effect);
  const double noise =
      emulator.change_leverage(position) * static_cast<double>(study.misfit.size());
  return emulator.unseen_bends(position)(effect) *
         std::max(0., emulator.change(position).squaredNorm() - noise);
}

/// Whether that square is not negligible beside the variance of the data along the effect's change.
bool may_bend(const StudyState &study, const Fit &fit, const Emulator &emulator,
              const Eigen::Index effect)
{
  constexpr double negligible = 0.25;
  const Eigen::VectorXd squares = emulator.change(alone(fit, effect)).cwiseAbs2();
  return unseen_square(study, fit, emulator, effect) * squares.sum() >
         negligible * squares.dot(study.misfit.variance(fit.leverage));
}

} // namespace

Eigen::VectorXd next_design_position(const StudyState &study, const Fit &fit)
{
  const Emulator emulator = study.emulator(fit.effects);
  Eigen::VectorXd place = fit.position;
  for (Eigen::Index k = 0; k < place.size(); ++k)
    if (may_bend(study, fit, emulator, k))
      place(k) *= 0.5;
  return place;
}

double optimistic_distance(const StudyState &study, const Fit &fit)
{
  const Emulator emulator = study.emulator(fit.effects);
  double square = 0.;
  for (Eigen::Index k = 0; k < fit.position.size(); ++k)
    square += unseen_square(study, fit, emulator, k);
  return study.misfit.distance(fit.remainder,
                               fit.leverage + square / static_cast<double>(study.misfit.size()));
}

} // namespace eunoe::discovery
