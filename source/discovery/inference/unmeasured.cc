#include <eunoe/discovery/inference/unmeasured.h>
#include <eunoe/discovery/statistics/covariance.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace eunoe::discovery {

std::vector<MeasuredExperiment> imagined(const std::vector<std::string> &experiments,
                                         const Samples &samples, const std::set<DataPoint> &without)
{
  std::vector<MeasuredPoint> points;
  for (const std::string &experiment : experiments) {
    const auto &names = samples.simulator().data_points(experiment);
    std::vector<Eigen::Index> columns(names.size());
    std::iota(columns.begin(), columns.end(), 0);
    const Eigen::MatrixXd base = runs_of_base(samples.of(experiment), columns);
    const Eigen::VectorXd deviation = deviations(base);
    for (const Eigen::Index c : columns) {
      const DataPoint &point = names[static_cast<std::size_t>(c)];
      const bool complete =
          std::all_of(samples.of(experiment).begin(), samples.of(experiment).end(),
                      [c](const Sample &sample) { return std::isfinite(sample.values(c)); });
      if (without.count(point) == 0 && complete && deviation(c) > 0.)
        points.push_back({point, base.col(c).mean(), deviation(c), tuned::plan::repeats});
    }
  }
  return sort_by_experiment(points, samples);
}

Unmeasured::Unmeasured(const StudyOptions &options, const std::vector<std::string> &experiments,
                       const std::vector<Factor> &factors, Simulator &simulator)
    : experiments(experiments), space(factors), samples(options, space, simulator, experiments),
      design(options, space, samples, experiments)
{
}

void Unmeasured::run()
{
  design.run_base();
  design.run_effects([this] { return target(); });
}

Target Unmeasured::target() const
{
  const auto measured = imagined(experiments, samples);
  if (measured.empty())
    throw UserError(
        "No data point varies and is given by every run, so there is nothing to compare. Ask "
        "for other observables.");
  return {measured, samples, 0.};
}

} // namespace eunoe::discovery
