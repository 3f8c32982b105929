#ifndef eunoe_discovery_inference_learning_curve_h
#define eunoe_discovery_inference_learning_curve_h

#include <eunoe/discovery/inference/describe.h>

namespace eunoe::discovery {

/// The answer after each round, by the number of runs.
class LearningCurve
{
public:
  void add(const Findings &findings, const FactorSpace &space, std::uint64_t runs);

  /// A row of discovery.json for each round.
  const Json &rows() const { return list; }

  /// Whether the last three rounds gave the same answer; six where nothing is detected and p lies
  /// near the level, which it may cross by chance.
  bool is_steady(double level) const;

private:
  /// Number of last rounds with the same answer.
  std::size_t n_alike() const;

  Json list = Json::array();
};

} // namespace eunoe::discovery

#endif
