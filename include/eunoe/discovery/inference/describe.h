#ifndef eunoe_discovery_inference_describe_h
#define eunoe_discovery_inference_describe_h

#include <eunoe/discovery/inference/decision.h>

#include <nlohmann/json.hpp>

#include <limits>
#include <optional>

namespace eunoe::discovery {

using Json = nlohmann::ordered_json;

/// Tables of discovery.json (doc/discovery_json.md).

/// So many rows of a list, those with the largest numbers first.
Json largest_first(std::vector<std::pair<double, Json>> rows,
                   std::size_t most = std::numeric_limits<std::size_t>::max());

/// Names of a model's effects, joined by " + "; "none of the catalogue" for a discrepancy.
std::string name_of(const Model &model, const FactorSpace &space);

/// All effects by their probability, with what each says alone.
Json describe_candidates(const Evidence &evidence, const Findings &findings);

/// Amplitudes of the likeliest model with calibrated intervals and the posterior.
Json describe_amplitudes(const Evidence &evidence, const Findings &findings);

/// Models that the data do not tell apart.
Json describe_models(const std::vector<Model> &models, const FactorSpace &space);

/// Smallest amplitudes that would be seen, and bounds within which an amplitude lies.
Json describe_power(const Evidence &evidence, const Findings &findings, std::uint32_t seed);

/// Change by each effect at all data points in standard deviations of a run, its strength along
/// the amplitude, and cosines between the changes.
Json describe_fingerprints(const Evidence &evidence);

/// A measured data point beside a model with the nuisances at their best values for the data of the
/// fit.
struct FittedPoint
{
  DataPoint point;
  double measured, model;
  double
      deviation;   ///< of the one from the other, in standard deviations of a run of the base model
  double variance; ///< of it, by noise
  double scatter;  ///< standard deviation of a run of the model
};
/// All data points in the target's order.
using Fitted = std::vector<FittedPoint>;
Fitted fit_to(const Target &target, const EffectPositions &effects,
              const Eigen::VectorXd &nuisances);

/// Measured values beside those of the models, a row for each data point.
Json describe_envelopes(const Target &target, const Fitted &before,
                        const std::optional<Fitted> &after, double level);

/// The gap before and after: root mean square deviation between data and model over the data
/// points, in standard deviations of a run, less what noise explains; negative if noise explains
/// more than there is.
Json describe_gap(const Fitted &before, const std::optional<Fitted> &after);

/// Data points by how much they speak for one model against another, the most first.
Json decisive_points(const Fitted &first, const Fitted &second);

} // namespace eunoe::discovery

#endif
