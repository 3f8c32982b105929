#include <eunoe/discovery/statistics/response.h>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

namespace {

/// Number of amplitudes of one effect that are clearly apart, zero among them.
int n_levels(const std::vector<Response::Run> &runs, const Eigen::Index effect)
{
  constexpr double apart = 0.25;
  std::vector<double> levels = {0.};
  std::vector<double> all;
  for (const Response::Run &run : runs)
    all.push_back(run.position(effect));
  std::sort(all.begin(), all.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  for (const double x : all)
    if (std::all_of(levels.begin(), levels.end(),
                    [&](double level) { return std::abs(x - level) > apart; }))
      levels.push_back(x);
  // Runs that are all close to zero still make a slope.
  if (levels.size() == 1 && std::any_of(all.begin(), all.end(), [](double x) { return x != 0.; }))
    return 2;
  return static_cast<int>(levels.size());
}

} // namespace

Response::Response(const std::vector<Run> &runs, const Eigen::VectorXd &slope_squares)
    : least(Eigen::VectorXd::Zero(slope_squares.size())), most(least)
{
  const Eigen::Index n_effects = slope_squares.size();
  constexpr int highest_degree = 3;
  constexpr double beyond = 1.5;
  const Term none(static_cast<std::size_t>(n_effects), 0);
  terms.push_back(none);
  for (Eigen::Index k = 0; k < n_effects; ++k) {
    for (int power = 1; power <= std::min(n_levels(runs, k) - 1, highest_degree); ++power) {
      terms.push_back(none);
      terms.back()[static_cast<std::size_t>(k)] = power;
    }
    for (const Run &run : runs) {
      least(k) = std::min(least(k), beyond * run.position(k));
      most(k) = std::max(most(k), beyond * run.position(k));
    }
  }
  for (Eigen::Index k = 0; k < n_effects; ++k)
    for (Eigen::Index l = 0; l < k; ++l)
      if (std::any_of(runs.begin(), runs.end(), [&](const Run &run) {
            return run.position(k) != 0. && run.position(l) != 0.;
          }))
      {
        terms.push_back(none);
        terms.back()[static_cast<std::size_t>(k)] = terms.back()[static_cast<std::size_t>(l)] = 1;
      }

  const auto n_terms = static_cast<Eigen::Index>(terms.size());
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(n_terms, n_terms);
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(n_terms, runs.front().values.size());
  for (const Run &run : runs) {
    const Eigen::VectorXd t = terms_at(run.position);
    base_weight += run.position.isZero(0.) ? 1. / run.variance : 0.;
    normal += t * t.transpose() / run.variance;
    right += t * run.values.transpose() / run.variance;
  }
  // Expected sizes of terms over that of the slope: second order, third order, products.
  constexpr double expected_bend[] = {0.4, 0.15}, expected_product = 0.4;
  for (Eigen::Index t = 1; t < n_terms; ++t) {
    double square = 1.;
    int order = 0;
    for (Eigen::Index k = 0; k < n_effects; ++k)
      if (const int power = terms[static_cast<std::size_t>(t)][static_cast<std::size_t>(k)];
          power > 0) {
        order = std::max(order, power);
        square *= slope_squares(k);
      }
    const bool is_product = std::count(terms[static_cast<std::size_t>(t)].begin(),
                                       terms[static_cast<std::size_t>(t)].end(), 1) == 2;
    if (is_product)
      square = std::sqrt(square) * expected_product * expected_product;
    else if (order > 1)
      square *= expected_bend[order - 2] * expected_bend[order - 2];
    normal(t, t) += is_product || order > 1 ? 1. / square : 0.;
    normal(t, t) *= 1. + 1e-9;
  }
  inverse = normal.ldlt().solve(Eigen::MatrixXd::Identity(n_terms, n_terms));
  coefficients = inverse * right;
}

Eigen::VectorXd Response::terms_at(const Eigen::VectorXd &position) const
{
  Eigen::VectorXd result(static_cast<Eigen::Index>(terms.size()));
  for (std::size_t t = 0; t < terms.size(); ++t) {
    double product = 1.;
    for (std::size_t k = 0; k < terms[t].size(); ++k)
      for (int power = 0; power < terms[t][k]; ++power)
        product *= position(static_cast<Eigen::Index>(k));
    result(static_cast<Eigen::Index>(t)) = product;
  }
  return result;
}

Eigen::VectorXd Response::change(const Eigen::VectorXd &position) const
{
  Eigen::VectorXd t = terms_at(position);
  t(0) = 0.;
  return coefficients.transpose() * t;
}

double Response::change_leverage(const Eigen::VectorXd &position) const
{
  Eigen::VectorXd t = terms_at(position);
  t(0) = 0.;
  return t.dot(inverse * t);
}

double Response::leverage(const Eigen::VectorXd &position) const
{
  const Eigen::VectorXd t = terms_at(position);
  return t.dot(inverse * t);
}

Response Response::with_shifted_base(const Eigen::VectorXd &shift) const
{
  Response result = *this;
  result.coefficients += base_weight * inverse.col(0) * shift.transpose();
  return result;
}

Response Response::transformed(const Eigen::MatrixXd &transform) const
{
  Response result = *this;
  result.coefficients = coefficients * transform.transpose();
  return result;
}

} // namespace eunoe::discovery
