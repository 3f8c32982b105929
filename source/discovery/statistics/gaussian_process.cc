#include <eunoe/discovery/statistics/covariance.h>
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

/// The distribution over columns from which rows come whose log-likelihoods these are: by
/// expectation and maximisation, with a little of each column in advance.
/// @return log-likelihood of all rows
double fit_mixture(const Eigen::MatrixXd &logs, Eigen::MatrixXd &probabilities)
{
  constexpr int iterations = 20;
  using tuned::kernel::in_advance;
  const Eigen::VectorXd largest = logs.rowwise().maxCoeff();
  const Eigen::MatrixXd likelihoods = (logs.colwise() - largest).array().exp();
  Eigen::VectorXd shares =
      Eigen::VectorXd::Constant(logs.cols(), 1. / static_cast<double>(logs.cols()));
  Eigen::VectorXd sums;
  for (int i = 0; i < iterations; ++i) {
    sums = likelihoods * shares;
    probabilities = sums.cwiseInverse().asDiagonal() * likelihoods * shares.asDiagonal();
    shares = probabilities.colwise().sum().transpose().array() + in_advance;
    shares /= shares.sum();
  }
  return (sums.array().log() + largest.array()).sum() + in_advance * shares.array().log().sum();
}

} // namespace

LinearBase BaseInformation::solve() const
{
  const Eigen::Index n = weighted.rows();
  LinearBase result{weighted, precision};
  for (Eigen::Index v = 0; v < weighted.cols(); ++v) {
    const Eigen::MatrixXd matrix = precision.col(v).reshaped(n, n);
    const Eigen::LLT<Eigen::MatrixXd> llt(matrix);
    const Eigen::MatrixXd covariance = llt.solve(Eigen::MatrixXd::Identity(n, n));
    result.coefficients.col(v) = llt.solve(weighted.col(v));
    result.covariance.col(v) = covariance.reshaped();
  }
  return result;
}

double GaussianProcess::Kernel::at(const double a, const double b) const
{
  const double s = std::pow(std::abs(a), power), t = std::pow(std::abs(b), power);
  const bool same_side = (a < 0.) == (b < 0.);
  return (same_side ? 1. : -1.) * s * t + (same_side ? roughness * std::min(s, t) : 0.);
}

GaussianProcess::GaussianProcess(std::vector<Point> points, const BaseInformation &base,
                                 const std::vector<double> &variances)
    : all(std::move(points)), base(base.solve())
{
  const auto n = static_cast<Eigen::Index>(all.size());
  roots.resize(n);
  terms.resize(n, base.weighted.rows());
  values.resize(n, base.weighted.cols());
  for (Eigen::Index k = 0; k < n; ++k) {
    const Point &point = all[static_cast<std::size_t>(k)];
    roots(k) = 1. / std::sqrt(point.variance);
    terms.row(k) = base_terms(point.nuisances).transpose();
    values.row(k) = point.mean.transpose();
  }
  if (all.empty())
    return;
  for (const double variance : variances)
    scales.push_back({variance, {}, {}, {}, {}});
  choose_kernel();
  for (Scale &scale : scales) {
    scale.weight = (1. + scale.variance * axes.eigenvalues.array()).inverse();
    const Eigen::MatrixXd weighted = axes.terms.transpose() * scale.weight.asDiagonal(),
                          precision = weighted * axes.terms;
    scale.precision = precision.reshaped();
    scale.weighted = weighted * axes.values;
  }
  set_base(base);
}

GaussianProcess::Axes GaussianProcess::axes_of(const Kernel &kernel) const
{
  const Eigen::Index n = terms.rows();
  Eigen::MatrixXd matrix(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j <= i; ++j) {
      const Point &a = all[static_cast<std::size_t>(i)], &b = all[static_cast<std::size_t>(j)];
      matrix(i, j) = roots(i) * roots(j) * kernel.at(a.amplitude, b.amplitude) *
                     (1. + kernel.interaction * a.nuisances.dot(b.nuisances));
    }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(matrix); // reads the lower half
  const Eigen::MatrixXd project = eigen.eigenvectors().transpose() * roots.asDiagonal();
  return {eigen.eigenvectors(), eigen.eigenvalues().cwiseMax(0.), project * terms,
          project * values};
}

/// Of each value's points, for each variance.
Eigen::MatrixXd GaussianProcess::log_likelihoods(
    const Axes &candidate, const std::vector<Eigen::MatrixXd> &base_roots) const
{
  const Eigen::Index n_terms = terms.cols();
  const Eigen::MatrixXd residuals = candidate.values - candidate.terms * base.coefficients;
  Eigen::MatrixXd result(values.cols(), static_cast<Eigen::Index>(scales.size()));
  for (Eigen::Index j = 0; j < result.cols(); ++j) {
    const Eigen::VectorXd spread =
        1. + scales[static_cast<std::size_t>(j)].variance * candidate.eigenvalues.array();
    const Eigen::MatrixXd weighted =
        candidate.terms.transpose() * spread.cwiseInverse().asDiagonal();
    const Eigen::MatrixXd precision = weighted * candidate.terms, along = weighted * residuals;
    const Eigen::VectorXd distances = residuals.cwiseAbs2().transpose() * spread.cwiseInverse();
    const double log_determinant = spread.array().log().sum();
    for (Eigen::Index v = 0; v < result.rows(); ++v) {
      // The base model is uncertain, too (Woodbury).
      const Eigen::MatrixXd &root = base_roots[static_cast<std::size_t>(v)];
      const Eigen::LLT<Eigen::MatrixXd> inner(Eigen::MatrixXd::Identity(n_terms, n_terms) +
                                              root.transpose() * precision * root);
      result(v, j) = -0.5 * (log_determinant + distances(v) -
                             inner.matrixL().solve(root.transpose() * along.col(v)).squaredNorm()) -
                     half_log_determinant(inner);
    }
  }
  return result;
}

void GaussianProcess::choose_kernel()
{
  std::vector<Eigen::MatrixXd> base_roots;
  for (Eigen::Index v = 0; v < values.cols(); ++v) {
    const Eigen::MatrixXd covariance = base.covariance.col(v).reshaped(terms.cols(), terms.cols());
    base_roots.emplace_back(covariance.llt().matrixL());
  }
  double highest = -std::numeric_limits<double>::infinity();
  const auto consider = [&](const Kernel &kernel) {
    const Axes candidate = axes_of(kernel);
    Eigen::MatrixXd probabilities;
    const double log_likelihood =
        fit_mixture(log_likelihoods(candidate, base_roots), probabilities);
    if (log_likelihood > highest) {
      highest = log_likelihood;
      best = kernel;
      axes = candidate;
      shares = probabilities;
    }
  };
  for (const double power : tuned::kernel::powers)
    for (const double roughness : tuned::kernel::roughness)
      consider({power, roughness, 0.});
  const Kernel without = best;
  if (all.front().nuisances.size() > 0)
    for (const double interaction : tuned::kernel::interactions)
      consider({without.power, without.roughness, interaction});
}

void GaussianProcess::set_base(const BaseInformation &others)
{
  base = others.solve();
  for (Scale &scale : scales) {
    BaseInformation together = others;
    together.precision.colwise() += scale.precision;
    together.weighted += scale.weighted;
    scale.base = together.solve();
  }
}

BaseInformation GaussianProcess::about_base() const
{
  const Eigen::Index n_terms = terms.cols();
  BaseInformation result{Eigen::MatrixXd::Zero(n_terms * n_terms, values.cols()),
                         Eigen::MatrixXd::Zero(n_terms, values.cols())};
  for (std::size_t j = 0; j < scales.size(); ++j) {
    const Eigen::VectorXd share = shares.col(static_cast<Eigen::Index>(j));
    result.precision += scales[j].precision * share.transpose();
    result.weighted += scales[j].weighted * share.asDiagonal();
  }
  return result;
}

GaussianProcess::Prediction GaussianProcess::predict(const double amplitude) const
{
  const Eigen::Index n_terms = terms.cols(), n_nuisances = n_terms - 1;
  const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(n_terms, n_terms);
  const Eigen::VectorXd diagonal = unit.reshaped();
  Prediction result{base.coefficients.row(0).transpose(),
                    base.coefficients.bottomRows(n_nuisances).transpose(),
                    base.covariance.transpose() * diagonal}; // sums of variances
  if (all.empty())
    return result;
  const auto n = static_cast<Eigen::Index>(all.size());
  // A row for the outcome at the nuisances' null values, and one for each column of the gradient.
  Eigen::MatrixXd cross(n_terms, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Point &point = all[static_cast<std::size_t>(k)];
    cross.col(k) = roots(k) * best.at(amplitude, point.amplitude) *
                   base_terms(best.interaction * point.nuisances);
  }
  cross *= axes.directions;
  const double prior =
      best.at(amplitude, amplitude) * (1. + best.interaction * static_cast<double>(n_nuisances));
  Eigen::MatrixXd means = Eigen::MatrixXd::Zero(n_terms, values.cols());
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(values.cols());
  result.leverage.setZero();
  for (std::size_t j = 0; j < scales.size(); ++j) {
    const Scale &scale = scales[j];
    const Eigen::VectorXd share = shares.col(static_cast<Eigen::Index>(j));
    // What the points say of the effect for a given base model, and of the base model thereby.
    const Eigen::MatrixXd gain = scale.variance * cross * scale.weight.asDiagonal();
    const Eigen::MatrixXd of_base = unit - gain * axes.terms;
    const Eigen::MatrixXd mean = gain * axes.values + of_base * scale.base.coefficients;
    const double of_effect = scale.variance * (prior - gain.cwiseProduct(cross).sum());
    const Eigen::VectorXd variance =
        scale.base.covariance.transpose() * (of_base.transpose() * of_base).reshaped() +
        Eigen::VectorXd::Constant(values.cols(), std::max(0., of_effect));
    means += mean * share.asDiagonal();
    squares += share.cwiseProduct(mean.row(0).transpose().cwiseAbs2());
    result.leverage += share.cwiseProduct(variance);
  }
  result.mean = means.row(0).transpose();
  result.gradient = means.bottomRows(n_nuisances).transpose();
  // The variances of the kernel differ in what they expect.
  result.leverage += (squares - result.mean.cwiseAbs2()).cwiseMax(0.);
  result.leverage = result.leverage.cwiseMax(1e-4);
  return result;
}

} // namespace eunoe::discovery
