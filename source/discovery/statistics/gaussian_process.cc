#include <eunoe/discovery/statistics/gaussian_process.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace eunoe::discovery {

namespace {

/// 1 and the nuisances: the terms of the base model.
Eigen::VectorXd base_terms(const Eigen::VectorXd &nuisances)
{
  Eigen::VectorXd terms(nuisances.size() + 1);
  terms << 1., nuisances;
  return terms;
}

} // namespace

LinearBase BaseInformation::solve() const
{
  const Eigen::LLT<Eigen::MatrixXd> llt(precision);
  return {llt.solve(weighted),
          llt.solve(Eigen::MatrixXd::Identity(precision.rows(), precision.cols()))};
}

double GaussianProcess::Kernel::at(const double a, const double b) const
{
  const double s = std::pow(std::abs(a), power), t = std::pow(std::abs(b), power);
  const bool same_side = (a < 0.) == (b < 0.);
  return variance *
         ((same_side ? 1. : -1.) * s * t + (same_side ? roughness * std::min(s, t) : 0.));
}

GaussianProcess::GaussianProcess(std::vector<Point> points, const LinearBase &base)
    : all(std::move(points)), base(base)
{
  const auto n = static_cast<Eigen::Index>(all.size());
  terms.resize(n, base.coefficients.rows());
  values.resize(n, base.coefficients.cols());
  for (Eigen::Index k = 0; k < n; ++k) {
    const Point &point = all[static_cast<std::size_t>(k)];
    terms.row(k) = base_terms(point.nuisances).transpose();
    values.row(k) = point.mean.transpose();
  }
  if (all.empty())
    return;
  choose_kernel();
  set_base(base);
}

void GaussianProcess::set_base(const LinearBase &others)
{
  base = others;
  if (all.empty())
    return;
  solver.compute(effect_covariance(best) + terms * base.covariance * terms.transpose());
  weights = solver.solve(values - terms * base.coefficients);
}

BaseInformation GaussianProcess::about_base() const
{
  const Eigen::LLT<Eigen::MatrixXd> llt(effect_covariance(best));
  const Eigen::MatrixXd weighted = llt.solve(terms).transpose();
  return {weighted * terms, weighted * values};
}

/// Covariance of the points for a given base model.
Eigen::MatrixXd GaussianProcess::effect_covariance(const Kernel &kernel) const
{
  const auto n = static_cast<Eigen::Index>(all.size());
  Eigen::MatrixXd result(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j <= i; ++j) {
      const Point &a = all[static_cast<std::size_t>(i)], &b = all[static_cast<std::size_t>(j)];
      result(i, j) = result(j, i) = kernel.at(a.amplitude, b.amplitude) *
                                        (1. + kernel.interaction * a.nuisances.dot(b.nuisances)) +
                                    (i == j ? a.variance : 0.);
    }
  return result;
}

void GaussianProcess::choose_kernel()
{
  const Eigen::MatrixXd residuals = values - terms * base.coefficients,
                        of_base = terms * base.covariance * terms.transpose();
  const auto n_values = static_cast<double>(residuals.cols());
  double highest = -std::numeric_limits<double>::infinity();
  const bool has_nuisances = all.front().nuisances.size() > 0;
  const auto consider = [&](const Kernel &kernel) {
    const Eigen::LLT<Eigen::MatrixXd> llt(effect_covariance(kernel) + of_base);
    const double log_determinant =
        2. * Eigen::MatrixXd(llt.matrixL()).diagonal().array().log().sum();
    const double distance = llt.matrixL().solve(residuals).squaredNorm();
    const double log_likelihood = -0.5 * (n_values * log_determinant + distance);
    if (log_likelihood > highest) {
      highest = log_likelihood;
      best = kernel;
    }
  };
  for (const double power : {0.45, 0.7, 1.})
    for (const double roughness : {0.03, 0.3, 1.})
      for (double variance = 0.01; variance < 3e4; variance *= 4.)
        consider({power, roughness, variance, 0.});
  const Kernel without = best;
  if (has_nuisances)
    for (const double interaction : {0.01, 0.05, 0.2}) {
      Kernel kernel = without;
      kernel.interaction = interaction;
      consider(kernel);
    }
}

GaussianProcess::Prediction GaussianProcess::predict(const double amplitude) const
{
  const Eigen::Index n_nuisances = base.coefficients.rows() - 1;
  Prediction result;
  result.mean = base.coefficients.row(0).transpose();
  result.gradient = base.coefficients.bottomRows(n_nuisances).transpose();
  result.leverage = base.covariance.trace();
  if (all.empty())
    return result;
  const auto n = static_cast<Eigen::Index>(all.size());
  // A row for the outcome at the nuisances' null values, and one for each column of the gradient.
  Eigen::MatrixXd cross(n_nuisances + 1, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Point &point = all[static_cast<std::size_t>(k)];
    const double along = best.at(amplitude, point.amplitude);
    cross.col(k) = base.covariance * base_terms(point.nuisances);
    cross(0, k) += along;
    cross.col(k).tail(n_nuisances) += along * best.interaction * point.nuisances;
  }
  const Eigen::MatrixXd change = cross * weights;
  result.mean += change.row(0).transpose();
  result.gradient += change.bottomRows(n_nuisances).transpose();
  const double prior = best.at(amplitude, amplitude);
  result.leverage += prior * (1. + best.interaction * static_cast<double>(n_nuisances)) -
                     cross.transpose().cwiseProduct(solver.solve(cross.transpose())).sum();
  result.leverage = std::max(result.leverage, 1e-4);
  return result;
}

} // namespace eunoe::discovery
