#include <eunoe/discovery/inference/unmeasured.h>

#include <cmath>

namespace eunoe::discovery {

std::vector<MeasuredExperiment> imagined(const std::vector<std::string> &experiments,
                                         const Samples &samples, const Simulator &simulator,
                                         const unsigned int repeats,
                                         const std::set<DataPoint> &without)
{
  std::vector<MeasuredPoint> points;
  for (const std::string &experiment : experiments) {
    const auto &names = simulator.data_points(experiment);
    for (std::size_t c = 0; c < names.size(); ++c) {
      if (without.count(names[c]) > 0)
        continue;
      std::vector<double> values;
      bool complete = true;
      for (const Sample &sample : samples.of(experiment)) {
        const double value = sample.values(static_cast<Eigen::Index>(c));
        complete = complete && std::isfinite(value);
        if (sample.position.isZero(0.))
          values.push_back(value);
      }
      double mean = 0., square = 0.;
      for (const double value : values)
        mean += value / static_cast<double>(values.size());
      for (const double value : values)
        square += std::pow(value - mean, 2);
      const double deviation = std::sqrt(square / std::max<double>(1., values.size() - 1.));
      if (complete && deviation > 0.)
        points.push_back({names[c], mean, deviation, repeats});
    }
  }
  std::vector<std::string> notes;
  return sort_by_experiment(points, samples, simulator, notes);
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
  constexpr unsigned int repeats = 4;
  auto measured = imagined(experiments, samples, samples.simulator(), repeats);
  if (measured.empty())
    throw UserError(
        "No data point varies and is given by every run, so there is nothing to compare. Ask "
        "for other observables.");
  return {std::move(measured), samples, space, 0.};
}

} // namespace eunoe::discovery
