#ifndef eunoe_discovery_inference_held_out_h
#define eunoe_discovery_inference_held_out_h

#include <eunoe/discovery/inference/describe.h>
#include <eunoe/discovery/inference/predictive.h>
#include <eunoe/discovery/inference/refutation.h>

#include <optional>

namespace eunoe::discovery {

/// Tests the answer on experiments whose data were not used: runs them with the base model, with
/// the nuisances moved and with each model of the answer near its amplitudes, and compares
/// predictions with what was measured.
class HeldOut
{
public:
  HeldOut(const StudyOptions &options, const DecisionRule &rule, const MeasuredData &data,
          Samples &samples);

  /// Largest number of runs of a test that is not in doubt.
  std::uint64_t n_runs() const;

  /// Runs and tests, in rounds as long as models that are not tested come into the answer, and
  /// takes out what the data refute.
  /// @param evidence of the data of the fit
  /// @return table of discovery.json
  Json test(const Evidence &evidence, Findings &findings);

private:
  /// The held-out data beside the predictions of the base model and, after it, of others, and what
  /// they say of the models.
  struct Test
  {
    Target target;
    Contest contest;
    TestedModels tested;
  };
  /// Models of the answer, and others that held-out data might speak for.
  std::vector<Model> first_tested(const Findings &by_fit) const;
  /// Runs the models and compares those that could be run.
  Test compare(const Evidence &fit, const std::vector<Model> &wanted, unsigned int runs);
  /// Whether more runs could change what the data say of a model of the answer.
  bool is_doubtful(const TestedModels &tested, const std::vector<Model> &answer) const;
  /// Adds at most so many models that are not yet among those that are tested, as far as the budget
  /// has room.
  void add(const std::vector<Model> &wanted, std::size_t most, std::vector<Model> &models) const;
  /// @param leader place of the model that leads the answer
  Json describe_test(const Test &test, const Findings &by_fit,
                     const std::optional<std::size_t> &leader) const;

  const StudyOptions &options;
  const DecisionRule &rule;
  const MeasuredData &data;
  Samples &samples;
  const std::vector<std::string> experiments;
};

} // namespace eunoe::discovery

#endif
