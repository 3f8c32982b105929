#include <eunoe/discovery/inference/challengers.h>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

namespace {

/// Log of prior and evidence that a model of one or two effects could have, for a single effect all
/// its amplitudes together.
double log_hope(const Evidence &evidence, const Model &model)
{
  // Standard deviations by which a likelihood may turn out larger than expected.
  constexpr double by_chance = 1.5;
  const Eigen::VectorXd &data = evidence.target().data();
  return model.effects.size() == 1
             ? log_sum(evidence.optimistic(model.effects.front(), data, by_chance))
             : evidence.optimistic_pair(model, data);
}

} // namespace

bool has_challenger(const Evidence &evidence, const Findings &findings)
{
  constexpr double enough = 0.05;
  const double temperature = findings.calibration.temperature;
  const Model &first = findings.models.front();
  // With which probability a model would stand beside the others as they are now. (A model outside
  // of a tie of several may have a twentieth of the first one's for ever.)
  const auto hoped = [&](const Model &model) {
    const double log_evidence = log_hope(evidence, model) - model.log_prior;
    return first.probability * std::exp(model.log_prior - first.log_prior +
                                        (log_evidence - first.log_evidence) / temperature);
  };
  return std::any_of(findings.models.begin(), findings.models.end(), [&](const Model &model) {
    if (model.is_discrepancy)
      return false;
    double needed = enough;
    for (const Model &member : findings.answer) {
      if (is_part(model, member))
        return false;
      if (is_part(member, model))
        needed = std::max(needed, member.probability);
    }
    return hoped(model) > needed;
  });
}

bool could_be_detected(const Evidence &evidence, const Findings &findings)
{
  const double needed = findings.threshold + evidence.log_nothing(evidence.target().data())(0);
  return std::any_of(findings.models.begin(), findings.models.end(), [&](const Model &model) {
    return model.effects.size() == 1 && log_hope(evidence, model) > needed;
  });
}

} // namespace eunoe::discovery
