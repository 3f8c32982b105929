#ifndef eunoe_tests_discovery_known_laboratory_h
#define eunoe_tests_discovery_known_laboratory_h

// What laboratories have in common whose models are known, so that discoveries can be made hundreds
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

class KnownLaboratory : public Laboratory
{
public:
  const std::vector<Cell> &cells(const std::string &experiment) const override
  {
    return all_cells.at(experiment);
  }

  std::vector<RunResult> run(const std::vector<RunRequest> &requests) override
  {
    std::vector<RunResult> results;
    for (const RunRequest &request : requests) {
      ++made;
      results.push_back(outcome(request));
    }
    return results;
  }

  std::uint64_t n_runs() const override { return made; }
  std::uint64_t n_cached() const override { return 0; }

  const std::vector<Factor> &factors() const { return all_factors; }
  std::vector<Factor> factors_without(const std::string &name) const
  {
    std::vector<Factor> result;
    for (const Factor &f : all_factors)
      if (f.name != name)
        result.push_back(f);
    return result;
  }

  /// Mean of an experiment's cells in runs with these amplitudes.
  virtual Eigen::VectorXd mean(const std::string &experiment,
                               const Amplitudes &amplitudes) const = 0;

  /// Mahalanobis distance from the base model in the chaos of one run of each experiment.
  double strength(const Amplitudes &amplitudes, const std::vector<std::string> &experiments) const
  {
    double square = 0.;
    for (const std::string &e : experiments) {
      const Eigen::VectorXd change = mean(e, amplitudes) - mean(e, {});
      square += half.at(e).triangularView<Eigen::Lower>().solve(change).squaredNorm();
    }
    return std::sqrt(square);
  }

  /// The same in standard errors of a measurement, after what nuisances could explain is taken off:
  /// how clear a truth is to someone who knows covariance, nuisances and fingerprints.
  double clearness(const Amplitudes &amplitudes, const std::vector<std::string> &experiments,
                   double repeats) const
  {
    Eigen::Index n = 0;
    for (const std::string &e : experiments)
      n += half.at(e).rows();
    Eigen::VectorXd change(n);
    Eigen::MatrixXd nuisances(n, 0);
    Eigen::Index row = 0;
    for (const std::string &e : experiments) {
      const auto &lower = half.at(e).triangularView<Eigen::Lower>();
      const auto in_units = [&](const Amplitudes &a) -> Eigen::VectorXd {
        return std::sqrt(repeats) * lower.solve(mean(e, a) - mean(e, {}));
      };
      Eigen::Index column = 0;
      Amplitudes effects = amplitudes;
      for (const Factor &f : all_factors) {
        if (f.kind != Factor::Kind::nuisance)
          continue;
        effects.erase(f.name);
        if (row == 0)
          nuisances.conservativeResize(n, column + 1);
        nuisances.col(column++).segment(row, half.at(e).rows()) =
            in_units({{f.name, f.null_value + f.prior_deviation}});
      }
      change.segment(row, half.at(e).rows()) = in_units(effects);
      row += half.at(e).rows();
    }
    // (1 + G G')^-1 by the matrix inversion lemma.
    const Eigen::MatrixXd inner = Eigen::MatrixXd::Identity(nuisances.cols(), nuisances.cols()) +
                                  nuisances.transpose() * nuisances;
    const Eigen::VectorXd along = nuisances.transpose() * change;
    return std::sqrt(change.squaredNorm() - along.dot(inner.ldlt().solve(along)));
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

  /// Means and deviations of repeated measurements of an experiment, with other seeds than any
  /// study's, and noise of the instrument in shares of each cell's chaos.
  std::vector<MeasuredCell> measure(const std::string &experiment, const Amplitudes &truth,
                                    unsigned int repeats, double instrument,
                                    std::uint32_t seed) const
  {
    RandomStream random(seed, 7);
    const auto n = static_cast<Eigen::Index>(all_cells.at(experiment).size());
    Eigen::MatrixXd rows(repeats, n);
    const Eigen::VectorXd chaos = half.at(experiment).rowwise().norm();
    for (unsigned int r = 0; r < repeats; ++r)
      rows.row(r) = (value(experiment, truth, 0x80000000u + 100u * seed + r) +
                     instrument * chaos.cwiseProduct(random.normals(1, n).row(0).transpose()))
                        .transpose();
    std::vector<MeasuredCell> result;
    for (Eigen::Index c = 0; c < n; ++c) {
      const double m = rows.col(c).mean();
      const double s =
          std::sqrt((rows.col(c).array() - m).square().sum() / std::max(1u, repeats - 1));
      result.push_back({all_cells.at(experiment)[static_cast<std::size_t>(c)], m, s, repeats});
    }
    return result;
  }

  MeasuredData measure(const std::vector<std::string> &fit,
                       const std::vector<std::string> &held_out, const Amplitudes &truth,
                       unsigned int repeats, double instrument, std::uint32_t seed) const
  {
    MeasuredData data;
    for (const std::string &e : fit)
      for (const MeasuredCell &cell : measure(e, truth, repeats, instrument, seed))
        data.fit.push_back(cell);
    for (const std::string &e : held_out)
      for (const MeasuredCell &cell : measure(e, truth, repeats, instrument, seed + 50000))
        data.held_out.push_back(cell);
    return data;
  }

protected:
  /// What a run gives, if it does not fail.
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

  std::map<std::string, std::vector<Cell>> all_cells;
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
};

} // namespace test

#endif
