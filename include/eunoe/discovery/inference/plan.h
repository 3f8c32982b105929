#ifndef eunoe_discovery_inference_plan_h
#define eunoe_discovery_inference_plan_h

#include <eunoe/discovery/inference/describe.h>
#include <eunoe/discovery/inference/predictive.h>

namespace eunoe::discovery {

/// Measurements that would tell the models of an answer apart: those that were made, once more, and
/// experiments that were not measured.
Json plan_for_tie(const Evidence &evidence, const Findings &findings, const StudyOptions &options,
                  Samples &samples);

/// Runs experiments at a few amplitudes of models' posteriors where there are not as many runs near
/// them already, with nuisances moved, and the base model.
/// @param runs of each model in each experiment
void run_near(const Evidence &evidence, const std::vector<Model> &models, unsigned int runs,
              const std::vector<std::string> &experiments, Samples &samples);

/// Most runs that run_near makes for a number of models.
std::uint64_t runs_to_test(unsigned int models, unsigned int runs,
                           const std::vector<std::string> &experiments, const Samples &samples);

} // namespace eunoe::discovery

#endif
