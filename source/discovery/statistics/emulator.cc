#include <eunoe/discovery/statistics/emulator.h>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

namespace {

/// Number of distinct amplitudes of one effect, with zero.
int n_levels(const std::vector<Emulator::Run> &runs, const Eigen::Index effect)
{
  constexpr double apart = 0.25;
  std::vector<double> levels = {0.};
  std::vector<double> all;
  for (const Emulator::Run &run : runs)
    all.push_back(run.position(effect));
  std::sort(all.begin(), all.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  for (const double x : all)
    if (std::all_of(levels.begin(), levels.end(),
                    [&](double level) { return std::abs(x - level) > apart; }))
      levels.push_back(x);
  // Amplitudes that are all close to zero still give a slope.
  if (levels.size() == 1 && std::any_of(all.begin(), all.end(), [](double x) { return x != 0.; }))
    return 2;
  return static_cast<int>(levels.size());
}

/// Prior change of a slope when the amplitude grows by a factor of e, over the slope.
constexpr double expected_turn = 0.4;

/// Next amplitude of an effect beyond a level that was run, on the side of a number; 0 if there is
/// none.
double next_level(const std::vector<Emulator::Run> &runs, const Eigen::Index effect,
                  const double level, const double side)
{
  double next = 0.;
  for (const Emulator::Run &run : runs) {
    const double u = run.position(effect);
    if (u * side > 0. && std::abs(u) > std::abs(level) &&
        (next == 0. || std::abs(u) < std::abs(next)))
      next = u;
  }
  return next;
}

/// Amplitudes of an effect that are followed by a far larger one. A smooth polynomial that fits the
/// runs beyond such an amplitude would be wrong below it, so the emulator has a kink there.
std::vector<double> knots(const std::vector<Emulator::Run> &runs, const Eigen::Index effect)
{
  constexpr double far = 3., much_larger = 6.;
  std::vector<double> result;
  for (const Emulator::Run &run : runs) {
    const double u = run.position(effect);
    if (u == 0. || std::find(result.begin(), result.end(), u) != result.end())
      continue;
    const bool goes_on = std::any_of(runs.begin(), runs.end(), [&](const Emulator::Run &other) {
      return other.position(effect) / u >= much_larger;
    });
    if (goes_on || next_level(runs, effect, u, u) / u >= far)
      result.push_back(u);
  }
  return result;
}

} // namespace

void Emulator::add_terms(const std::vector<Run> &runs, const Eigen::Index n_effects)
{
  constexpr int highest_degree = 3;
  const Term none{std::vector<int>(static_cast<std::size_t>(n_effects), 0)};
  terms.push_back(none);
  for (Eigen::Index k = 0; k < n_effects; ++k) {
    const auto add = [&](int power, double knot) {
      terms.push_back(none);
      terms.back().powers[static_cast<std::size_t>(k)] = power;
      terms.back().knot = knot;
    };
    for (int power = 1; power <= std::min(n_levels(runs, k) - 1, highest_degree); ++power)
      add(power, 0.);
    for (const double knot : knots(runs, k))
      add(1, knot);
  }
  for (Eigen::Index k = 0; k < n_effects; ++k)
    for (Eigen::Index l = 0; l < k; ++l)
      if (std::any_of(runs.begin(), runs.end(), [&](const Run &run) {
            return run.position(k) != 0. && run.position(l) != 0.;
          }))
      {
        terms.push_back(none);
        terms.back().powers[static_cast<std::size_t>(k)] = 1;
        terms.back().powers[static_cast<std::size_t>(l)] = 1;
      }
}

double Emulator::stiffness(const Term &term, const std::vector<Run> &runs,
                           const Slopes &slopes) const
{
  // Expected sizes over that of the slope: second order, third order, products.
  constexpr double expected_bend[] = {0.4, 0.15}, expected_product = 0.4;
  double square = 1.;
  int order = 0, n_factors = 0;
  for (Eigen::Index k = 0; k < slopes.overall.size(); ++k)
    if (const int power = term.powers[static_cast<std::size_t>(k)]; power > 0) {
      order = std::max(order, power);
      ++n_factors;
      square *= slopes.overall(k);
      if (term.knot != 0.) {
        // Before the first amplitude only the mean slope is known; the mean of log(first / u) is 1.
        const double unseen = next_level(runs, k, 0., term.knot) == term.knot ? 1. : 0.;
        const double further = std::log(next_level(runs, k, term.knot, term.knot) / term.knot);
        return 1. / (slopes.steepest(k) * expected_turn * expected_turn * (unseen + further));
      }
    }
  if (n_factors == 2)
    return 1. / (std::sqrt(square) * expected_product * expected_product);
  return order > 1 ? 1. / (square * expected_bend[order - 2] * expected_bend[order - 2]) : 0.;
}

Emulator::Emulator(const std::vector<Run> &runs, const Slopes &slopes)
    : least(Eigen::VectorXd::Zero(slopes.overall.size())), most(least), first_below(least),
      first_above(least), overall(slopes.overall)
{
  constexpr double beyond = 1.5;
  for (const Run &run : runs) {
    least = least.cwiseMin(beyond * run.position);
    most = most.cwiseMax(beyond * run.position);
  }
  for (Eigen::Index k = 0; k < overall.size(); ++k) {
    first_below(k) = next_level(runs, k, 0., -1.);
    first_above(k) = next_level(runs, k, 0., 1.);
  }
  add_terms(runs, overall.size());
  const auto n_terms = static_cast<Eigen::Index>(terms.size());
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(n_terms, n_terms);
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(n_terms, runs.front().values.size());
  for (const Run &run : runs) {
    const Eigen::VectorXd t = terms_at(run.position);
    base_weight += run.position.isZero(0.) ? 1. / run.variance : 0.;
    normal += t * t.transpose() / run.variance;
    right += t * run.values.transpose() / run.variance;
  }
  for (Eigen::Index t = 1; t < n_terms; ++t) {
    normal(t, t) += stiffness(terms[static_cast<std::size_t>(t)], runs, slopes);
    normal(t, t) *= 1. + 1e-9;
  }
  inverse = normal.ldlt().solve(Eigen::MatrixXd::Identity(n_terms, n_terms));
  coefficients = inverse * right;
}

Eigen::VectorXd Emulator::terms_at(const Eigen::VectorXd &position) const
{
  Eigen::VectorXd result(static_cast<Eigen::Index>(terms.size()));
  for (std::size_t t = 0; t < terms.size(); ++t) {
    double product = 1.;
    for (std::size_t k = 0; k < terms[t].powers.size(); ++k) {
      const double knot = terms[t].knot, beyond = position(static_cast<Eigen::Index>(k)) - knot;
      const double x = knot > 0. ? std::max(0., beyond) : knot < 0. ? std::min(0., beyond) : beyond;
      for (int power = 0; power < terms[t].powers[k]; ++power)
        product *= x;
    }
    result(static_cast<Eigen::Index>(t)) = product;
  }
  return result;
}

Eigen::VectorXd Emulator::change(const Eigen::VectorXd &position) const
{
  Eigen::VectorXd t = terms_at(position);
  t(0) = 0.;
  return coefficients.transpose() * t;
}

double Emulator::change_leverage(const Eigen::VectorXd &position) const
{
  Eigen::VectorXd t = terms_at(position);
  t(0) = 0.;
  return t.dot(inverse * t);
}

double Emulator::leverage(const Eigen::VectorXd &position) const
{
  const Eigen::VectorXd t = terms_at(position);
  // By the mean slope, as changes themselves are noisy and the variance is spread over all values.
  return t.dot(inverse * t) +
         unseen_bends(position).dot(position.cwiseAbs2().cwiseProduct(overall));
}

Eigen::VectorXd Emulator::unseen_bends(const Eigen::VectorXd &position) const
{
  Eigen::VectorXd result = Eigen::VectorXd::Zero(overall.size());
  for (Eigen::Index k = 0; k < overall.size(); ++k) {
    const double u = position(k), first = u > 0. ? first_above(k) : first_below(k);
    if (u != 0. && std::abs(u) < std::abs(first))
      result(k) = expected_turn * expected_turn * std::log(first / u);
  }
  return result;
}

Emulator Emulator::with_shifted_base(const Eigen::VectorXd &shift) const
{
  Emulator result = *this;
  result.coefficients += base_weight * inverse.col(0) * shift.transpose();
  return result;
}

Emulator Emulator::transformed(const Eigen::MatrixXd &transform) const
{
  Emulator result = *this;
  result.coefficients = coefficients * transform.transpose();
  return result;
}

} // namespace eunoe::discovery
