#include <eunoe/discovery/inference/likelihood.h>
#include <eunoe/discovery/tuned.h>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

namespace {

/// Those of Sellentin and Heavens. (Their scale would be that of the plain estimate, whose
/// distances are too long; the shrunk one has no such error.)
double degrees_of_t(const Target &target)
{
  return std::max(tuned::scatter::least_degrees,
                  target.degrees_of_freedom() + 1. - static_cast<double>(target.data().size()));
}

/// A logarithm costs as much as ten products.
double log_of_product(const Eigen::Ref<const Eigen::VectorXd> &factors)
{
  constexpr Eigen::Index together = 4; // whose product is in range, be each as large as 1e75
  double result = 0.;
  for (Eigen::Index i = 0; i < factors.size(); i += together)
    result += std::log(factors.segment(i, std::min(together, factors.size() - i)).prod());
  return result;
}

} // namespace

Likelihood::Likelihood(const Target &target)
    : aim(target), dof(degrees_of_t(target)), base(prepare(target.predict({})))
{
}

Hypothesis Likelihood::prepare(const Target::Prediction &prediction,
                               const Eigen::MatrixXd &variances)
{
  const Eigen::Index n = prediction.gradient.cols(), size = prediction.mean.size();
  const Eigen::Index levels = variances.cols();
  Hypothesis result{prediction, variances.cwiseInverse(), Eigen::MatrixXd(size, levels * n),
                    Eigen::VectorXd(levels)};
  // There are few nuisances: plain sums are faster than products by blocks.
  for (Eigen::Index l = 0; l < levels; ++l) {
    result.constant(l) = -0.5 * log_of_product(variances.col(l));
    auto half = result.half.middleCols(l * n, n);
    half = result.inverse.col(l).asDiagonal() * prediction.gradient;
    const Eigen::MatrixXd root =
        (Eigen::MatrixXd::Identity(n, n) + prediction.gradient.transpose().lazyProduct(half))
            .llt()
            .matrixL();
    for (Eigen::Index q = 0; q < n; ++q) {
      for (Eigen::Index r = 0; r < q; ++r)
        half.col(q) -= root(q, r) * half.col(r);
      half.col(q) /= root(q, q);
      result.constant(l) -= std::log(root(q, q));
    }
  }
  return result;
}

Eigen::MatrixXd Hypothesis::distances(const Eigen::Ref<const Eigen::MatrixXd> &deviations) const
{
  Eigen::MatrixXd result = inverse.transpose() * deviations.cwiseAbs2();
  if (half.cols() == 0)
    return result;
  const Eigen::MatrixXd explained = (half.transpose() * deviations).cwiseAbs2();
  const Eigen::Index n = half.cols() / inverse.cols();
  for (Eigen::Index l = 0; l < result.rows(); ++l)
    result.row(l) -= explained.middleRows(l * n, n).colwise().sum();
  return result;
}

Eigen::ArrayXXd Likelihood::log_t(const Eigen::ArrayXd &constants,
                                  const Eigen::ArrayXXd &distances) const
{
  const double exponent = 0.5 * (dof + static_cast<double>(aim.data().size()));
  return (-exponent * (1. + distances / dof).log()).colwise() + constants;
}

Eigen::ArrayXXd Likelihood::log_of_levels(const Hypothesis &hypothesis, const Eigen::VectorXd &mean,
                                          const Eigen::Ref<const Eigen::MatrixXd> &data) const
{
  return log_t(hypothesis.constant, hypothesis.distances(data.colwise() - mean));
}

Eigen::ArrayXd Likelihood::log_likelihoods_about(
    const Hypothesis &hypothesis, const Eigen::VectorXd &mean,
    const Eigen::Ref<const Eigen::MatrixXd> &data) const
{
  return log_sums(log_of_levels(hypothesis, mean, data)) -
         std::log(static_cast<double>(hypothesis.inverse.cols()));
}

Eigen::VectorXd Likelihood::inverse_variance(const Hypothesis &hypothesis) const
{
  const Eigen::ArrayXd logs =
      log_of_levels(hypothesis, hypothesis.prediction.mean, aim.data()).col(0);
  const Eigen::ArrayXd weights = (logs - logs.maxCoeff()).exp();
  return hypothesis.inverse * (weights / weights.sum()).matrix();
}

double Likelihood::log_optimistic(const Hypothesis &hypothesis, const double deviations) const
{
  Target::Prediction known = hypothesis.prediction;
  known.leverage = known.leverage.cwiseMin(base.prediction.leverage);
  const Eigen::VectorXd share =
      1. - aim.variance(known).array() / aim.variance(hypothesis.prediction).array();
  known.mean += share.cwiseProduct(aim.data() - known.mean);
  // The mean will not lie where the data pull it, but scatters about that by what is left of its
  // error: otherwise those who know least would hope for more than the truth can have.
  return log_likelihood(prepare(known), aim.data()) - 0.5 * share.sum() +
         deviations * std::sqrt(share.sum());
}

} // namespace eunoe::discovery
