#include <eunoe/discovery/stages/models.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace eunoe::discovery {

Eigen::VectorXd Objective::change(const Eigen::VectorXd &position, double &leverage) const
{
  const Eigen::VectorXd change = emulator.change(position);
  const double noise = emulator.change_leverage(position) * static_cast<double>(misfit.size());
  const double square = change.squaredNorm();
  const double share = square > noise ? 1. - noise / square : 0.;
  leverage = (1. - share) * emulator.origin_leverage() + share * emulator.leverage(position);
  return share * change;
}

Fit Objective::at(const Eigen::VectorXd &position) const
{
  Fit fit;
  fit.position = position;
  fit.remainder = data - emulator.origin() - change(position, fit.leverage);
  fit.distance = misfit.distance(fit.remainder, fit.leverage);
  fit.deviance = misfit.deviance(fit.distance, misfit.log_determinant(fit.leverage));
  return fit;
}

Bounds bounds(const StudyState &study, const EffectSet &set, const Emulator &emulator)
{
  const auto n = static_cast<Eigen::Index>(set.size());
  Bounds result{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
  for (Eigen::Index k = 0; k < n; ++k) {
    const Factor &effect = study.effects[set[static_cast<std::size_t>(k)]];
    double lower = (effect.lower - effect.null_value) / effect.scale;
    double upper = (effect.upper - effect.null_value) / effect.scale;
    if (effect.sign == Factor::Sign::above)
      lower = 0.;
    if (effect.sign == Factor::Sign::below)
      upper = 0.;
    result.lower(k) = std::min(0., std::max(lower, emulator.lower(k)));
    result.upper(k) = std::max(0., std::min(upper, emulator.upper(k)));
  }
  return result;
}

namespace {

/// Minimum along one effect: a coarse scan, then golden sections about the best point.
double minimise_along(const Objective &objective, const Bounds &bounds, Eigen::VectorXd position,
                      const Eigen::Index effect)
{
  constexpr int coarse = 12, sections = 12;
  const double low = bounds.lower(effect), high = bounds.upper(effect);
  if (high <= low)
    return low;
  const auto value = [&](double x) {
    position(effect) = x;
    return objective.at(position).deviance;
  };
  double best = position(effect), least = value(best);
  for (int k = 0; k <= coarse; ++k) {
    const double x = low + (high - low) * k / coarse, y = value(x);
    if (y < least) {
      least = y;
      best = x;
    }
  }
  const double step = (high - low) / coarse, golden = 0.5 * (std::sqrt(5.) - 1.);
  double a = std::max(low, best - step), b = std::min(high, best + step);
  double c = b - golden * (b - a), d = a + golden * (b - a), fc = value(c), fd = value(d);
  for (int k = 0; k < sections; ++k) {
    if (fc < fd) {
      b = d;
      d = c;
      fd = fc;
      fc = value(c = b - golden * (b - a));
    } else {
      a = c;
      c = d;
      fc = fd;
      fd = value(d = a + golden * (b - a));
    }
  }
  const double x = fc < fd ? c : d;
  return std::min(fc, fd) < least ? x : best;
}

} // namespace

Fit minimise(const Objective &objective, const Bounds &bounds)
{
  const Eigen::Index n = bounds.lower.size();
  constexpr int sweeps = 12;
  const Eigen::VectorXd start =
      Eigen::VectorXd::Zero(n).cwiseMax(bounds.lower).cwiseMin(bounds.upper);
  Fit best = objective.at(start);
  if (n == 0)
    return best;
  // Descents that begin with different effects may end in different valleys.
  for (Eigen::Index first = 0; first < (n > 1 ? n : 1); ++first) {
    Eigen::VectorXd position = start;
    double before = std::numeric_limits<double>::infinity();
    for (int sweep = 0; sweep < (n > 1 ? sweeps : 1); ++sweep) {
      for (Eigen::Index k = 0; k < n; ++k) {
        const Eigen::Index effect = (first + k) % n;
        position(effect) = minimise_along(objective, bounds, position, effect);
      }
      const Fit fit = objective.at(position);
      if (fit.deviance < best.deviance)
        best = fit;
      if (before - fit.deviance < 1e-4)
        break;
      before = fit.deviance;
    }
  }
  return best;
}

Eigen::VectorXd data_coordinates(const StudyState &study)
{
  return study.misfit.coordinates(study.modes.reduce(study.value));
}

Fit fit_model(const StudyState &study, const EffectSet &set)
{
  const Emulator emulator = study.emulator(set);
  const Eigen::VectorXd data = data_coordinates(study);
  Fit fit = minimise(Objective(study.misfit, emulator, data), bounds(study, set, emulator));
  fit.effects = set;
  return fit;
}

Interval profile_interval(const StudyState &study, const Fit &fit, const std::size_t member,
                          const double allowed)
{
  const Emulator emulator = study.emulator(fit.effects);
  const Eigen::VectorXd data = data_coordinates(study);
  const Objective objective(study.misfit, emulator, data);
  const Bounds all = bounds(study, fit.effects, emulator);
  const auto k = static_cast<Eigen::Index>(member);
  const auto inside = [&](double x) {
    Bounds pinned = all;
    pinned.lower(k) = pinned.upper(k) = x;
    return minimise(objective, pinned).deviance - fit.deviance <= allowed;
  };
  // The first position outside, in steps from the best, then by bisection.
  const auto end = [&](double limit, bool &open) {
    constexpr int steps = 24, halves = 24;
    double in = fit.position(k);
    open = true;
    for (int step = 1; step <= steps && open; ++step) {
      double out = fit.position(k) + (limit - fit.position(k)) * step / steps;
      if (inside(out)) {
        in = out;
        continue;
      }
      open = false;
      for (int half = 0; half < halves; ++half) {
        const double middle = 0.5 * (in + out);
        (inside(middle) ? in : out) = middle;
      }
    }
    return in;
  };
  Interval interval{};
  interval.lower = end(all.lower(k), interval.open_below);
  interval.upper = end(all.upper(k), interval.open_above);
  return interval;
}

} // namespace eunoe::discovery
