#include <eunoe/discovery/inference/target.h>
#include <eunoe/discovery/statistics/covariance.h>
#include <eunoe/discovery/tuned.h>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

namespace {

/// Least standard deviation of each data point between runs that is believed: a share of its
/// observable's typical one, so that a difference in the last digit is not significant.
Eigen::VectorXd least_deviations(const MeasuredExperiment &measured, const Samples &samples)
{
  using tuned::scatter::least_share;
  const Eigen::MatrixXd rows = runs_of_base(samples.of(measured.name), measured.columns);
  constexpr Eigen::Index fewest = 4;
  if (rows.rows() < fewest)
    throw TooFewRuns("Only " + std::to_string(rows.rows()) + " runs of the base model of '" +
                     measured.name +
                     "' reached their end, which is too few to compare anything with. See the "
                     "failures in its table of runs, or ask for more runs.");
  const Eigen::VectorXd deviation = deviations(rows);
  Eigen::VectorXd result(deviation.size());
  for (Eigen::Index c = 0; c < deviation.size(); ++c) {
    std::vector<double> same;
    for (Eigen::Index d = 0; d < deviation.size(); ++d)
      if (measured.points[static_cast<std::size_t>(c)].observable ==
          measured.points[static_cast<std::size_t>(d)].observable)
        same.push_back(deviation(d));
    std::sort(same.begin(), same.end());
    const double median = same[same.size() / 2], size = std::abs(rows.col(c).mean());
    double typical = median > 0. ? median : same.back();
    if (typical <= 1e-12 * size)
      typical = measured.deviation(c) / least_share;
    result(c) = std::max(least_share * typical, 1e-300);
  }
  return result;
}

} // namespace

std::vector<MeasuredExperiment> sort_by_experiment(const std::vector<MeasuredPoint> &points,
                                                   const Samples &samples)
{
  std::map<std::string, std::vector<const MeasuredPoint *>> sorted;
  for (const MeasuredPoint &point : points)
    sorted[point.point.experiment].push_back(&point);
  std::vector<MeasuredExperiment> result;
  for (const auto &[name, rows] : sorted) {
    MeasuredExperiment one;
    one.name = name;
    const auto n = static_cast<Eigen::Index>(rows.size());
    one.value.resize(n);
    one.deviation.resize(n);
    one.repeats.resize(n);
    const auto &known = samples.simulator().data_points(name);
    for (Eigen::Index k = 0; k < n; ++k) {
      const MeasuredPoint &row = *rows[static_cast<std::size_t>(k)];
      const auto place = std::find(known.begin(), known.end(), row.point);
      if (place == known.end())
        throw UserError("Experiment '" + name + "' does not give observable '" +
                        row.point.observable + "', index " + std::to_string(row.point.index) + ".");
      one.points.push_back(row.point);
      one.columns.push_back(place - known.begin());
      one.value(k) = row.value;
      one.deviation(k) = row.standard_deviation;
      one.repeats(k) = row.repeats;
    }
    one.least_deviation = least_deviations(one, samples);
    result.push_back(std::move(one));
  }
  return result;
}

Target::Part::Part(const MeasuredExperiment &one, const Samples &samples,
                   const double model_tolerance, const Eigen::Index first)
    : measured(one),
      emulator(samples.space(), samples.of(one.name), one.columns, one.points, one.least_deviation),
      noise(emulator.modes(), emulator.mode_covariance(),
            one.deviation.cwiseQuotient(emulator.base_deviation()), one.repeats),
      tolerance(model_tolerance *
                emulator.base_mean().cwiseQuotient(emulator.base_deviation()).cwiseAbs()),
      repeats(1. / one.repeats.cwiseInverse().mean()), first(first)
{
  const auto &groups = emulator.modes().groups();
  Eigen::MatrixXd excess = Eigen::MatrixXd::Zero(tolerance.size(), n_noise_levels); // of each point
  for (Eigen::Index l = 0; l < excess.cols(); ++l) {
    const auto &level = noise.at((static_cast<double>(l) + 0.5) / n_noise_levels);
    for (std::size_t g = 0; g < groups.size(); ++g)
      for (const Eigen::Index c : groups[g].points)
        excess(c, l) = level[g].mean();
  }
  const Eigen::VectorXd mean_excess = excess.rowwise().mean();
  point_ratio = mean_excess.array() + 1.;
  ratio = point_ratio.mean();
  const auto covariance = [&](const Eigen::VectorXd &of_points) -> Eigen::MatrixXd {
    const Eigen::MatrixXd root =
        emulator.whiten_scaled(Eigen::MatrixXd(of_points.cwiseSqrt().asDiagonal()));
    return root * root.transpose();
  };
  const Eigen::VectorXd of_means = one.repeats.cwiseInverse();
  averaging =
      emulator.whiten_scaled(of_means.cwiseSqrt().asDiagonal() *
                             (emulator.modes().basis().transpose() * emulator.unwhitening()));
  Eigen::MatrixXd correlated =
      covariance(mean_excess.cwiseProduct(of_means) + tolerance.cwiseAbs2());
  if (of_means.minCoeff() < of_means.maxCoeff())
    correlated += averaging * averaging.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(correlated);
  rotation = eigen.eigenvectors().transpose();
  mean_scatter = (rotation * averaging).rowwise().squaredNorm();
  const auto variance = [&](const Eigen::VectorXd &of_points) -> Eigen::VectorXd {
    return (rotation * covariance(of_points) * rotation.transpose()).diagonal().cwiseMax(0.);
  };
  tolerated = variance(tolerance.cwiseAbs2());
  // All levels have nearly the same axes.
  instrument.resize(emulator.size(), n_noise_levels);
  for (Eigen::Index l = 0; l < instrument.cols(); ++l)
    instrument.col(l) = variance(excess.col(l).cwiseQuotient(one.repeats));
}

Target::Target(const std::vector<MeasuredExperiment> &measured, const Samples &samples,
               const double model_tolerance)
{
  Eigen::Index n = 0;
  for (const MeasuredExperiment &one : measured) {
    parts.emplace_back(one, samples, model_tolerance, n);
    n += parts.back().emulator.size();
  }
  all.resize(n);
  for (const Part &part : parts)
    part.of(all) = part.rotation * part.emulator.whiten(part.measured.value);
}

double Target::Part::share_of_instrument(const double scatter) const
{
  return ratio > 1. ? std::clamp((ratio - scatter) / (ratio - 1.), 0., 1.) : 1.;
}

double Target::degrees_of_freedom() const
{
  double least = parts.front().emulator.degrees_of_freedom();
  for (const Part &part : parts)
    least = std::min(least, part.emulator.degrees_of_freedom());
  return least;
}

Target::Prediction Target::predict(const EffectPositions &effects) const
{
  Prediction result;
  const auto n_parts = static_cast<Eigen::Index>(parts.size());
  result.mean.resize(all.size());
  result.leverage.resize(all.size());
  result.scatter.resize(all.size());
  result.common.resize(n_parts);
  for (Eigen::Index e = 0; e < n_parts; ++e) {
    const Part &part = parts[static_cast<std::size_t>(e)];
    const ExperimentEmulator::Prediction whitened = part.emulator.predict(effects);
    const GaussianProcess::Prediction &one = whitened.outcome;
    if (e == 0)
      result.gradient.resize(all.size(), one.gradient.cols());
    part.of(result.mean) = part.rotation * one.mean;
    part.of(result.gradient) = part.rotation * one.gradient;
    part.of(result.leverage) = part.rotation.cwiseAbs2() * one.leverage;
    part.of(result.scatter) = part.rotation.cwiseAbs2() * whitened.scatter;
    result.common(e) = whitened.common;
  }
  return result;
}

Eigen::MatrixXd Target::variances(const Prediction &prediction) const
{
  Eigen::MatrixXd result(all.size(), n_noise_levels);
  for (std::size_t e = 0; e < parts.size(); ++e) {
    const Part &part = parts[e];
    const double left = part.share_of_instrument(prediction.common(static_cast<Eigen::Index>(e)));
    const Eigen::VectorXd of_runs = part.of(prediction.scatter).cwiseProduct(part.mean_scatter) +
                                    part.of(prediction.leverage) + part.tolerated;
    part.of(result) = (left * part.instrument).colwise() + of_runs;
  }
  return result;
}

} // namespace eunoe::discovery
