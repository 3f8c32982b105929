#ifndef eunoe_discovery_inference_plan_h
#define eunoe_discovery_inference_plan_h

#include <eunoe/discovery/inference/describe.h>
#include <eunoe/discovery/inference/predictive.h>

namespace eunoe::discovery {

/// Measurements that would tell the models of an answer apart: those that were made, once more, and
/// experiments that were not measured.
Json plan_for_tie(const Evidence &evidence, const Findings &findings, const StudyOptions &options,
                  const FactorSpace &space, Samples &samples);

/// Runs experiments at a few amplitudes of models' posteriors, with nuisances moved, and the base
/// model.
/// @param runs of each model in each experiment
void run_near(const Evidence &evidence, const std::vector<Model> &models, unsigned int runs,
              const FactorSpace &space, const std::vector<std::string> &experiments,
              Samples &samples);

/// Most runs of an experiment that run_near makes for one model, and without any.
unsigned int most_runs_near(unsigned int runs);
unsigned int runs_of_base(unsigned int runs, std::size_t n_nuisances);

} // namespace eunoe::discovery

#endif
