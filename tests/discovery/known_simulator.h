#ifndef eunoe_tests_discovery_known_simulator_h
#define eunoe_tests_discovery_known_simulator_h

// Base of simulators whose models are known, so that studies can be made hundreds
// of times and compared with the truth: strengths of effects, amplitudes that have a given
// strength, and measurements of a truth.

#include <eunoe/core/random.h>
#include <eunoe/discovery/statistics/random_stream.h>
#include <eunoe/discovery/study.h>

#include <Eigen/Dense>
#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace test {

using namespace eunoe;
using namespace eunoe::discovery;

class KnownSimulator : public Simulator
{
public:
  const std::vector<DataPoint> &data_points(const std::string &experiment) const override
  {
    return all_points.at(experiment);
  }

  std::vector<RunResult> run(const std::vector<RunRequest> &requests) override
  {
    std::vector<RunResult> results;
    for (const RunRequest &request : requests) {
      ++made;
      results.push_back(outcome(request));
      if (remembers)
        memory[request.experiment].emplace_back(request, results.back());
    }
    return results;
  }

  /// From now on runs are known to later studies, as from a table of runs.
  void remember() { remembers = true; }
  std::vector<std::pair<RunRequest, RunResult>> known(const std::string &experiment) override
  {
    return memory[experiment];
  }

  std::uint64_t n_runs() const { return made; }

  const std::vector<Factor> &factors() const { return all_factors; }
  std::vector<Factor> factors_without(const std::string &name) const
  {
    std::vector<Factor> result;
    for (const Factor &f : all_factors)
      if (f.name != name)
        result.push_back(f);
    return result;
  }

  /// Mean of an experiment's data points in runs with these amplitudes.
  virtual Eigen::VectorXd mean(const std::string &experiment,
                               const Amplitudes &amplitudes) const = 0;

  /// Mahalanobis distance from the base model, in units of the scatter of one run of each
  /// experiment.
  double strength(const Amplitudes &amplitudes, const std::vector<std::string> &experiments) const
  {
    return change(amplitudes, experiments).norm();
  }

  /// Amplitude of an effect that has this strength.
  double amplitude_of(const std::string &name, double wanted,
                      const std::vector<std::string> &experiments, double side = 1.) const
  {
    const Factor &f = factor(name);
    double low = 0., high = 50.;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      (strength({{name, f.null_value + side * middle * f.scale}}, experiments) < wanted ? low
                                                                                        : high) =
          middle;
    }
    return f.null_value + side * low * f.scale;
  }

  const Factor &factor(const std::string &name) const
  {
    for (const Factor &f : all_factors)
      if (f.name == name)
        return f;
    throw std::runtime_error("no factor " + name);
  }

  /// Means and deviations of repeated measurements of an experiment, with seeds that no study uses,
  /// and noise of the instrument as a share of each data point's scatter.
  std::vector<MeasuredPoint> measure(const std::string &experiment, const Amplitudes &truth,
                                     unsigned int repeats, double instrument,
                                     std::uint32_t seed) const
  {
    RandomStream random(seed, 7);
    const auto n = static_cast<Eigen::Index>(all_points.at(experiment).size());
    Eigen::MatrixXd rows(repeats, n);
    const Eigen::VectorXd chaos = half.at(experiment).rowwise().norm();
    for (unsigned int r = 0; r < repeats; ++r)
      rows.row(r) = (value(experiment, truth, 0x80000000u + 100u * seed + r) +
                     instrument * chaos.cwiseProduct(random.normals(1, n).row(0).transpose()))
                        .transpose();
    std::vector<MeasuredPoint> result;
    for (Eigen::Index c = 0; c < n; ++c) {
      const double m = rows.col(c).mean();
      const double s =
          std::sqrt((rows.col(c).array() - m).square().sum() / std::max(1u, repeats - 1));
      result.push_back({all_points.at(experiment)[static_cast<std::size_t>(c)], m, s, repeats});
    }
    return result;
  }

  MeasuredData measure(const std::vector<std::string> &fit,
                       const std::vector<std::string> &held_out, const Amplitudes &truth,
                       unsigned int repeats, double instrument, std::uint32_t seed) const
  {
    MeasuredData data;
    for (const std::string &e : fit)
      for (const MeasuredPoint &point : measure(e, truth, repeats, instrument, seed))
        data.fit.push_back(point);
    for (const std::string &e : held_out)
      for (const MeasuredPoint &point : measure(e, truth, repeats, instrument, seed + 50000))
        data.held_out.push_back(point);
    return data;
  }

  /// Changes of all data points of some experiments, in units in which the covariance of a run is
  /// the unit matrix.
  Eigen::VectorXd change(const Amplitudes &amplitudes,
                         const std::vector<std::string> &experiments) const
  {
    Eigen::VectorXd result;
    for (const std::string &e : experiments) {
      const Eigen::VectorXd part =
          half.at(e).triangularView<Eigen::Lower>().solve(mean(e, amplitudes) - mean(e, {}));
      result.conservativeResize(result.size() + part.size());
      result.tail(part.size()) = part;
    }
    return result;
  }

protected:
  /// The values of a run that does not fail.
  virtual Eigen::VectorXd value(const std::string &experiment, const Amplitudes &amplitudes,
                                std::uint32_t seed) const = 0;
  virtual bool fails(const RunRequest &) const { return false; }

  static std::uint32_t hash(const std::string &text)
  {
    std::uint32_t h = 2166136261u;
    for (const char c : text)
      h = (h ^ static_cast<unsigned char>(c)) * 16777619u;
    return h;
  }

  std::map<std::string, std::vector<DataPoint>> all_points;
  std::map<std::string, Eigen::MatrixXd> half; ///< of each experiment's covariance of one run
  std::vector<Factor> all_factors;

private:
  RunResult outcome(const RunRequest &request) const
  {
    if (fails(request))
      return std::nullopt;
    const Eigen::VectorXd v = value(request.experiment, request.amplitudes, request.seed);
    return std::vector<double>(v.data(), v.data() + v.size());
  }

  std::uint64_t made = 0;
  bool remembers = false;
  std::map<std::string, std::vector<std::pair<RunRequest, RunResult>>> memory;
};

} // namespace test

#endif
