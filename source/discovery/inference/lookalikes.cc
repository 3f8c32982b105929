#include <eunoe/discovery/inference/lookalikes.h>
#include <eunoe/discovery/inference/twins.h>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

namespace {

/// On each side of an effect's null value the place whose change is nearest to a strength, unless
/// its range ends clearly before that.
std::vector<const Evidence::Place *> places_of(const std::vector<Evidence::Place> &places,
                                               const double strength)
{
  std::vector<const Evidence::Place *> result;
  for (const bool above : {false, true}) {
    const Evidence::Place *nearest = nullptr;
    for (const Evidence::Place &place : places)
      if ((place.amplitude > 0.) == above &&
          place.strength > strength - tuned::twins::clearly_weaker &&
          (!nearest ||
           std::abs(place.strength - strength) <= std::abs(nearest->strength - strength)))
        nearest = &place;
    if (nearest)
      result.push_back(nearest);
  }
  return result;
}

} // namespace

double Lookalikes::log_evidence(const std::vector<Model> &models, const double temperature) const
{
  std::vector<double> logs;
  for (const Model &model : models)
    if (model.is_discrepancy)
      logs.push_back(std::log(recognised) + model.log_evidence / temperature);
    else if (model.effects.size() == 1)
      if (const auto share = taken_for.find(model.effects.front()); share != taken_for.end())
        logs.push_back(std::log(share->second) + model.log_evidence / temperature);
  return temperature * log_sum(logs);
}

Lookalikes find_lookalikes(const Evidence &evidence, const double strength, const double threshold,
                           const unsigned int draws, const std::uint32_t seed)
{
  Lookalikes result;
  result.strength = strength;
  const std::vector<std::size_t> effects = evidence.usable();
  if (effects.size() < 2)
    return result;
  std::vector<std::pair<std::size_t, const Evidence::Place *>> truths;
  std::map<std::size_t, double> sides;
  for (const std::size_t effect : effects)
    for (const Evidence::Place *place : places_of(evidence.places(effect), strength)) {
      truths.emplace_back(effect, place);
      ++sides[effect];
    }
  const auto n = static_cast<Eigen::Index>(effects.size());
  Eigen::ArrayXd shares = Eigen::ArrayXd::Zero(n + 1);
  Twins twins(evidence.target(), seed + 3);
  for (const auto &[left_out, place] : truths) {
    const Eigen::MatrixXd data =
        twins.draw(place->hypothesis.prediction,
                   std::max(1u, draws / static_cast<unsigned int>(truths.size())));
    const Eigen::ArrayXXd logs = evidence.singles(data, left_out).log_posterior();
    const Eigen::ArrayXd sums = log_sums(logs);
    const Eigen::ArrayXd detected = (sums - evidence.log_nothing(data) >= threshold).cast<double>();
    const Eigen::ArrayXXd probabilities = (logs.rowwise() - sums.transpose()).exp();
    shares += (probabilities.rowwise() * detected.transpose()).rowwise().mean() / sides[left_out];
  }
  if (shares.sum() <= 0.)
    return result;
  shares /= shares.sum();
  for (Eigen::Index k = 0; k < n; ++k)
    if (shares(k) > 0.)
      result.taken_for[effects[static_cast<std::size_t>(k)]] = shares(k);
  result.recognised = shares(n);
  return result;
}

} // namespace eunoe::discovery
