#ifndef eunoe_discovery_inference_design_h
#define eunoe_discovery_inference_design_h

#include <eunoe/discovery/inference/decision.h>
#include <eunoe/discovery/statistics/random_stream.h>

#include <functional>

namespace eunoe::discovery {

/// Which design points a study runs, in which order.
class Design
{
public:
  Design(const StudyOptions &options, const FactorSpace &space, Samples &samples,
         std::vector<std::string> experiments);

  /// Runs the base model and each nuisance on either side. Throws a UserError if the budget does
  /// not suffice for the base model.
  void run_base();

  /// Runs each effect at the ends of its range, and at amplitudes in geometric sequence from its
  /// scale down to what can just be seen; all effects in turns, the ends of their ranges first.
  /// Depends on the experiments alone, not on what was measured.
  void run_effects(const std::function<Target()> &estimate);

  /// Runs where it is expected to tell most: near the amplitudes at which models would be the
  /// likeliest if they were known better, by the error of their emulator.
  /// @return whether anything could be run
  bool refine(const Evidence &evidence, const Findings &findings);

  /// Runs where the amplitudes of these models may lie, until they are limited by what was measured
  /// and no longer by what has been run.
  /// @return whether anything could be run, and had to
  bool sharpen(const Evidence &evidence, const std::vector<Model> &answer);

  /// Runs where the emulators of effects know least, whatever will be measured.
  /// @return whether anything could be run
  bool fill(const Evidence &evidence);

private:
  /// A design point that may be run, of the base model if there is no such effect.
  struct Wish
  {
    std::size_t effect;
    double amplitude, weight;
  };
  bool run(std::vector<Wish> wishes, std::uint64_t n_points);
  /// Design points of a round after this many runs.
  std::uint64_t size_of_round(std::uint64_t n_runs) const;
  Eigen::VectorXd draw_nuisances();
  DesignPoint point(std::size_t effect, double amplitude);

  const StudyOptions &options;
  const FactorSpace &space;
  Samples &samples;
  const std::vector<std::string> experiments;
  RandomStream random;
};

} // namespace eunoe::discovery

#endif
