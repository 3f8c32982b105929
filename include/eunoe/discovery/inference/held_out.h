#ifndef eunoe_discovery_inference_held_out_h
#define eunoe_discovery_inference_held_out_h

#include <eunoe/discovery/inference/describe.h>
#include <eunoe/discovery/inference/predictive.h>

#include <functional>
#include <memory>

namespace eunoe::discovery {

/// Tests the answer on experiments whose data were not used: runs them with the base model, with
/// the nuisances moved and with each model of the answer near its amplitudes, and compares
/// predictions with what was measured.
class HeldOut
{
public:
  HeldOut(const StudyOptions &options, const DecisionRule &rule, const MeasuredData &data,
          const FactorSpace &space, Samples &samples);

  /// Largest number of runs of a test that is not in doubt.
  std::uint64_t n_runs() const;

  /// Runs and tests. Models that the data refute leave the answer, and in the end those that were
  /// not tested and only add to them an effect which the fit does not ask for. The last one that
  /// leaves takes the name with it.
  /// @param evidence of the data of the fit
  /// @return table of discovery.json
  Json test(const Evidence &evidence, Findings &findings);

private:
  /// The held-out data beside the predictions of the base model and, after it, of others.
  struct Comparison
  {
    Comparison(Target of_data, const FactorSpace &space,
               const std::function<Contest(const Evidence &)> &predict)
        : target(std::move(of_data)), evidence(target, space), contest(predict(evidence))
    {
    }
    double p(std::size_t place) const { return contest.p(place, target.data()); }

    const Target target;
    const Evidence evidence;
    const Contest contest;
  };
  /// Runs the models and compares; null if the data do not vary.
  std::unique_ptr<Comparison> compare(const Evidence &fit, const std::vector<Model> &models,
                                      unsigned int runs);
  /// Whether more runs could change what the data say of a model of the answer.
  bool is_doubtful(const Comparison &comparison, std::size_t n_answers) const;
  /// Adds models of the answer that are not yet tested, as far as the budget has room.
  void follow(const std::vector<Model> &answer, std::vector<Model> &models) const;
  /// @param is_last whether untested models fall with a refuted one
  Json test_models(const Evidence &fit, const Comparison &comparison,
                   const std::vector<Model> &models, bool is_last, Findings &findings) const;

  const StudyOptions &options;
  const DecisionRule &rule;
  const MeasuredData &data;
  const FactorSpace &space;
  Samples &samples;
  std::vector<std::string> experiments;
};

} // namespace eunoe::discovery

#endif
