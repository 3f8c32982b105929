#include <eunoe/discovery/inference/likelihood.h>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

namespace {

/// Those of Sellentin and Heavens. (Their scale would be that of the plain estimate, whose
/// distances are too long; the shrunk one has no such error.)
double degrees_of_t(const Target &target)
{
  constexpr double least = 10.;
  return std::max(least,
                  target.degrees_of_freedom() + 1. - static_cast<double>(target.data().size()));
}

} // namespace

double log_sum(const std::vector<double> &logarithms)
{
  const double largest = *std::max_element(logarithms.begin(), logarithms.end());
  double sum = 0.;
  for (const double value : logarithms)
    sum += std::exp(value - largest);
  return largest + std::log(sum);
}

Eigen::ArrayXd log_sums(const Eigen::ArrayXXd &logarithms)
{
  const Eigen::ArrayXd largest = logarithms.colwise().maxCoeff().transpose();
  return largest +
         (logarithms.rowwise() - largest.transpose()).exp().colwise().sum().transpose().log();
}

Likelihood::Likelihood(const Target &target)
    : aim(target), dof(degrees_of_t(target)), base(prepare(target.predict({})))
{
}

Hypothesis Likelihood::prepare(const Target::Prediction &prediction) const
{
  Eigen::MatrixXd variances(prediction.mean.size(),
                            static_cast<Eigen::Index>(Target::n_noise_levels));
  for (std::size_t l = 0; l < Target::n_noise_levels; ++l)
    variances.col(static_cast<Eigen::Index>(l)) = aim.variance(prediction, l);
  return prepare(prediction, variances);
}

Hypothesis Likelihood::prepare_roughly(const Target::Prediction &prediction) const
{
  return prepare(prediction, aim.variance(prediction));
}

Hypothesis Likelihood::prepare(const Target::Prediction &prediction,
                               const Eigen::MatrixXd &variances)
{
  const Eigen::Index n = prediction.gradient.cols(), size = prediction.mean.size();
  const Eigen::Index levels = variances.cols();
  Hypothesis result{prediction, variances.cwiseInverse().transpose(),
                    Eigen::MatrixXd(levels * n, size), Eigen::VectorXd(levels)};
  for (Eigen::Index l = 0; l < levels; ++l) {
    const Eigen::VectorXd inverse = result.inverse.row(l).transpose();
    result.constant(l) = 0.5 * inverse.array().log().sum();
    if (n == 0)
      continue;
    const Eigen::MatrixXd scaled = prediction.gradient.transpose() * inverse.asDiagonal();
    const Eigen::LLT<Eigen::MatrixXd> inner(Eigen::MatrixXd::Identity(n, n) +
                                            scaled * prediction.gradient);
    result.half.middleRows(l * n, n) = inner.matrixL().solve(scaled);
    result.constant(l) -= inner.matrixLLT().diagonal().array().log().sum();
  }
  return result;
}

Eigen::MatrixXd Hypothesis::distances(const Eigen::Ref<const Eigen::MatrixXd> &deviations) const
{
  Eigen::MatrixXd result = inverse * deviations.cwiseAbs2();
  if (half.rows() == 0)
    return result;
  const Eigen::MatrixXd explained = (half * deviations).cwiseAbs2();
  const Eigen::Index n = half.rows() / inverse.rows();
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
         std::log(static_cast<double>(hypothesis.inverse.rows()));
}

Eigen::VectorXd Likelihood::inverse_variance(const Hypothesis &hypothesis,
                                             const Eigen::VectorXd &data) const
{
  const Eigen::ArrayXd logs = log_of_levels(hypothesis, hypothesis.prediction.mean, data).col(0);
  const Eigen::ArrayXd weights = (logs - logs.maxCoeff()).exp();
  return hypothesis.inverse.transpose() * (weights / weights.sum()).matrix();
}

double Likelihood::log_optimistic(const Hypothesis &hypothesis, const Eigen::VectorXd &data,
                                  const double deviations) const
{
  Target::Prediction known = hypothesis.prediction;
  known.leverage = known.leverage.cwiseMin(base.prediction.leverage);
  const Eigen::VectorXd share =
      1. - aim.variance(known).array() / aim.variance(hypothesis.prediction).array();
  known.mean += share.cwiseProduct(data - known.mean);
  // The mean will not lie where the data pull it, but scatters about that by what is left of its
  // error: otherwise those who know least would hope for more than the truth can have.
  return log_likelihood(prepare(known), data) - 0.5 * share.sum() +
         deviations * std::sqrt(share.sum());
}

} // namespace eunoe::discovery
