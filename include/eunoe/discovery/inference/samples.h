#ifndef eunoe_discovery_inference_samples_h
#define eunoe_discovery_inference_samples_h

#include <eunoe/discovery/factor.h>
#include <eunoe/discovery/simulator.h>
#include <eunoe/discovery/study.h>

#include <Eigen/Dense>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace eunoe::discovery {

/// The factors of a study in a fixed order, effects first; positions in their joint space count
/// each amplitude from its null value, in scales of an effect and prior deviations of a nuisance.
class FactorSpace
{
public:
  explicit FactorSpace(const std::vector<Factor> &factors);

  std::size_t n_effects() const { return effects; }
  std::size_t n_nuisances() const { return all.size() - effects; }
  const Factor &effect(std::size_t k) const { return all[k]; }
  const Factor &nuisance(std::size_t k) const { return all[effects + k]; }

  /// Range of an effect's positions.
  double lower(std::size_t effect) const;
  double upper(std::size_t effect) const;

  Eigen::VectorXd origin() const
  {
    return Eigen::VectorXd::Zero(static_cast<Eigen::Index>(all.size()));
  }
  Amplitudes amplitudes(const Eigen::VectorXd &position) const;
  /// Nothing if an amplitude is that of no factor of the study.
  std::optional<Eigen::VectorXd> position(const Amplitudes &amplitudes) const;

private:
  std::vector<Factor> all;
  std::size_t effects; ///< their number
};

/// Positions of effects by their number; all others are at their null value.
using EffectPositions = std::map<std::size_t, double>;

/// A simulation; without values if it did not reach its end.
struct Sample
{
  Eigen::VectorXd position, values;
};

/// Some values of the runs of the base model, a row for each run.
Eigen::MatrixXd runs_of_base(const std::vector<Sample> &samples,
                             const std::vector<Eigen::Index> &columns);

/// Replicates of a design point that are wanted: runs of several experiments.
struct DesignPoint
{
  Eigen::VectorXd position;
  unsigned int replicates = 1;
};

/// The base model, and each nuisance at two prior deviations on either side.
std::vector<DesignPoint> points_of_base(const FactorSpace &space, unsigned int at_origin,
                                        unsigned int on_each_side);

/// The simulations that a study knows, those of its table and those it asks for, within its budget.
/// All have different seeds: chaos parts runs of equal seeds so soon that nothing is gained by
/// comparing them.
class Samples
{
public:
  Samples(const StudyOptions &options, const FactorSpace &space, Simulator &simulator,
          const std::vector<std::string> &experiments);

  /// Runs design points, as many as the budget has room for.
  /// @param turns of the points, if not one after the other: those of the first turn are run before
  ///   those of the next, and of each turn first one replicate of all. Seeds do not depend on it.
  void run(const std::vector<DesignPoint> &points, const std::vector<std::string> &experiments,
           const std::vector<unsigned int> &turns = {})
  {
    run(points, experiments, false, turns);
  }
  /// The same of the replicates that are missing in each experiment.
  void complete(const std::vector<DesignPoint> &points, const std::vector<std::string> &experiments)
  {
    run(points, experiments, true, {});
  }

  const std::vector<Sample> &of(const std::string &experiment) const
  {
    return samples.at(experiment);
  }
  /// Replicates of a design point that are still missing in an experiment that it concerns; failed
  /// ones are not missing.
  unsigned int n_missing(const DesignPoint &point, const std::string &experiment) const;
  /// Whether each experiment that an effect concerns has a run with it alone. Of what was never run
  /// an emulator would say that it changes nothing.
  bool has_any(std::size_t effect, const std::vector<std::string> &experiments) const
  {
    return has_near(effect, std::nullopt, 1, experiments);
  }
  /// Whether a run with an effect alone has failed in one of the experiments.
  bool has_failed(std::size_t effect, const std::vector<std::string> &experiments) const;
  /// Whether each experiment that an effect concerns has this many runs with nearly this amplitude.
  bool has_near(std::size_t effect, std::optional<double> amplitude, unsigned int runs,
                const std::vector<std::string> &experiments) const;

  /// Whether runs with nearly this amplitude fail in one of the experiments, such as where its
  /// input is refused, so that more of them would fail as well.
  bool fails_near(std::size_t effect, double amplitude,
                  const std::vector<std::string> &experiments) const;

  std::uint64_t n_asked() const { return asked; }
  /// Of those that it has asked for.
  std::uint64_t n_failed() const { return failed; }
  std::uint64_t n_known() const { return known; }
  std::uint64_t remaining() const;
  /// Keeps runs of the budget for later.
  void set_aside(std::uint64_t runs) { reserved = runs; }
  Simulator &simulator() const { return source; }
  const FactorSpace &space() const { return factors; }

private:
  void run(const std::vector<DesignPoint> &points, const std::vector<std::string> &experiments,
           bool only_missing, const std::vector<unsigned int> &turns);
  void add(const RunRequest &request, const RunResult &result);
  /// Number of runs with an effect alone, and with nearly this amplitude if there is one.
  std::size_t n_near(const std::vector<Sample> &runs, std::size_t effect,
                     std::optional<double> amplitude) const;

  const StudyOptions &options;
  const FactorSpace &factors;
  Simulator &source;
  std::map<std::string, std::vector<Sample>> samples, failures;
  std::map<std::pair<std::string, Amplitudes>, unsigned int> counts;
  std::uint32_t next_seed;
  std::uint64_t asked = 0, failed = 0, known = 0, reserved = 0;
};

} // namespace eunoe::discovery

#endif
