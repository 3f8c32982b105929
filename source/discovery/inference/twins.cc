#include <eunoe/discovery/inference/twins.h>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

/// Noise of an instrument that is not known, either, and error of the model, in whitened modes.
Eigen::VectorXd Twins::instrument(const Target::Part &part, const double scatter,
                                  const double quantile)
{
  Eigen::VectorXd noise(part.measured.repeats.size());
  const auto &groups = part.emulator.modes().groups();
  std::vector<double> excess;
  for (const ExcessVariance &group : part.noise.at(quantile))
    excess.push_back(group.draw(random) * part.share_of_instrument(scatter));
  for (std::size_t g = 0; g < groups.size(); ++g)
    for (const Eigen::Index c : groups[g].points)
      noise(c) = std::sqrt(excess[g] / part.measured.repeats(c) + std::pow(part.tolerance(c), 2)) *
                 random.normal();
  return part.emulator.whiten_scaled(noise);
}

Eigen::VectorXd Twins::draw(const Target::Prediction &truth)
{
  Eigen::VectorXd result = truth.mean;
  for (Eigen::Index q = 0; q < truth.gradient.cols(); ++q)
    result += random.normal() * truth.gradient.col(q);
  const double quantile = random.uniform();
  const auto &parts = target.experiments();
  for (std::size_t e = 0; e < parts.size(); ++e) {
    const Target::Part &part = parts[e];
    const Eigen::MatrixXd &rows = part.emulator.deviations();
    const auto repeats = std::max(1, static_cast<int>(std::lround(part.repeats)));
    const double length =
        kind == Scatter::as_a_distance ? std::sqrt(1. - part.emulator.own_share()) : 1.;
    const auto deviation = [&]() -> Eigen::VectorXd {
      const std::size_t row = random.index(static_cast<std::size_t>(rows.rows()));
      return length * rows.row(static_cast<Eigen::Index>(row)).transpose();
    };
    Eigen::VectorXd scatter = Eigen::VectorXd::Zero(rows.cols());
    for (int r = 0; r < repeats; ++r)
      scatter += deviation();
    part.of(result) += part.of(truth.scatter)
                           .cwiseSqrt()
                           .cwiseProduct(part.rotation * (part.averaging * scatter)) /
                       std::sqrt(repeats);
    part.of(result) +=
        part.of(truth.leverage).cwiseSqrt().cwiseProduct(part.rotation * deviation());
    part.of(result) +=
        part.rotation * instrument(part, truth.common(static_cast<Eigen::Index>(e)), quantile);
  }
  return result;
}

Eigen::MatrixXd Twins::draw(const Target::Prediction &truth, const unsigned int number)
{
  Eigen::MatrixXd result(truth.mean.size(), number);
  for (Eigen::Index k = 0; k < result.cols(); ++k)
    result.col(k) = draw(truth);
  return result;
}

Tail::Tail(const Eigen::ArrayXd &draws) : sorted(draws.begin(), draws.end())
{
  std::sort(sorted.rbegin(), sorted.rend());
  const std::size_t n = sorted.size() / tuned::twins::tail_one_in;
  if (n < 2)
    return;
  threshold = sorted[n];
  scale = 0.;
  for (std::size_t k = 0; k < n; ++k)
    scale += (sorted[k] - threshold) / static_cast<double>(n);
  share = static_cast<double>(n) / static_cast<double>(sorted.size());
}

double Tail::p(const double value) const
{
  if (share > 0. && value > threshold)
    return share * std::exp(-(value - threshold) / std::max(scale, 1e-300));
  const auto above = std::upper_bound(sorted.begin(), sorted.end(), value, std::greater<>());
  return (static_cast<double>(above - sorted.begin()) + 1.) /
         (static_cast<double>(sorted.size()) + 1.);
}

double Tail::quantile(const double p) const
{
  if (share > 0. && p < share)
    return threshold + scale * std::log(share / p);
  return sorted[std::min(sorted.size() - 1,
                         static_cast<std::size_t>(p * static_cast<double>(sorted.size())))];
}

Tail null_distribution(const Evidence &evidence, const unsigned int draws, const std::uint32_t seed)
{
  Twins twins(evidence.target(), seed);
  return Tail(evidence.log_bayes_factors(twins.draw(evidence.nothing().prediction, draws)));
}

} // namespace eunoe::discovery
