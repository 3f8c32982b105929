#include <eunoe/discovery/inference/amplitude_posterior.h>
#include <eunoe/discovery/inference/describe.h>

#include <boost/algorithm/string/join.hpp>
#include <boost/math/distributions/students_t.hpp>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

namespace {

double amplitude_of(const Factor &effect, const double position)
{
  return effect.null_value + position * effect.scale;
}

/// Values at the data points of one experiment for a vector of the target's coordinates.
Eigen::VectorXd values_of(const Target::Part &part, const Eigen::VectorXd &coordinates)
{
  return part.emulator.values(part.rotation.transpose() * part.of(coordinates));
}

Json name_of_point(const DataPoint &point)
{
  return {
      {"experiment", point.experiment}, {"observable", point.observable}, {"index", point.index}};
}

double gap(const Fitted &model)
{
  double square = 0.;
  for (const FittedPoint &point : model)
    square += point.deviation * point.deviation - point.variance;
  return std::copysign(std::sqrt(std::abs(square) / static_cast<double>(model.size())), square);
}

} // namespace

Json largest_first(std::vector<std::pair<double, Json>> rows, const std::size_t most)
{
  std::stable_sort(rows.begin(), rows.end(),
                   [](const auto &a, const auto &b) { return a.first > b.first; });
  Json result = Json::array();
  for (std::size_t k = 0; k < std::min(most, rows.size()); ++k)
    result.push_back(std::move(rows[k].second));
  return result;
}

std::string name_of(const Model &model, const FactorSpace &space)
{
  if (model.is_discrepancy)
    return "none of the catalogue";
  std::vector<std::string> names;
  for (const std::size_t k : model.effects)
    names.push_back(space.effect(k).name);
  return boost::join(names, " + ");
}

Json describe_candidates(const Evidence &evidence, const Findings &findings)
{
  const FactorSpace &space = evidence.space();
  const Eigen::VectorXd &data = evidence.target().data();
  std::vector<std::pair<double, Json>> rows;
  for (std::size_t k = 0; k < space.n_effects(); ++k) {
    const Factor &effect = space.effect(k);
    const double confidence = findings.detected ? probability_of(findings.models, k) : 0.;
    Json row = {{"effect", effect.name},
                {"confidence", confidence},
                {"mechanism", effect.mechanism},
                {"unit", effect.unit},
                {"source", effect.source}};
    if (!evidence.places(k).empty()) {
      const Model alone = evidence.single(k, data);
      row["log Bayes factor alone"] = alone.log_evidence - evidence.log_nothing(data)(0);
      row["amplitude alone"] = amplitude_of(effect, alone.best.at(k));
    }
    rows.emplace_back(confidence, row);
  }
  return largest_first(std::move(rows));
}

Json describe_amplitudes(const Evidence &evidence, const Findings &findings)
{
  Json rows = Json::array();
  if (findings.answer.empty() || findings.verdict == Verdict::off_catalogue)
    return rows;
  const Model &model = findings.answer.front();
  for (const std::size_t k : model.effects) {
    const Factor &effect = evidence.space().effect(k);
    const AmplitudePosterior posterior(evidence, model, evidence.target().data(), k);
    const auto [low, high] = posterior.likeliest(findings.calibration.interval);
    Json shape = Json::array();
    constexpr double least = 1e-3;
    for (const AmplitudePosterior::Place &place : posterior.places())
      if (place.probability > least)
        shape.push_back({amplitude_of(effect, place.amplitude), place.probability});
    const double range_low = evidence.space().lower(k), range_high = evidence.space().upper(k);
    rows.push_back({{"effect", effect.name},
                    {"unit", effect.unit},
                    {"amplitude", amplitude_of(effect, posterior.quantile(0.5))},
                    {"lower", amplitude_of(effect, low)},
                    {"upper", amplitude_of(effect, high)},
                    {"lower reached", low > 0.99 * range_low || range_low == 0.},
                    {"upper reached", high < 0.99 * range_high || range_high == 0.},
                    {"confidence", probability_of(findings.models, k)},
                    {"posterior", shape}});
  }
  return rows;
}

Json describe_models(const std::vector<Model> &models, const FactorSpace &space)
{
  Json rows = Json::array();
  for (const Model &model : models) {
    Json amplitudes = Json::object();
    for (const auto &[k, position] : model.best)
      amplitudes[space.effect(k).name] = amplitude_of(space.effect(k), position);
    rows.push_back({{"effects", name_of(model, space)},
                    {"probability", model.probability},
                    {"log evidence", model.log_evidence},
                    {"amplitudes", amplitudes}});
  }
  return rows;
}

Json describe_power(const Evidence &evidence, const Findings &findings, const std::uint32_t seed)
{
  Json rows = Json::array();
  const FactorSpace &space = evidence.space();
  const Eigen::VectorXd &data = evidence.target().data();
  // Half of the squared normal quantile of 95 %: where a likelihood has fallen to it.
  constexpr double fall = 1.92;
  for (std::size_t k = 0; k < space.n_effects(); ++k) {
    const Factor &effect = space.effect(k);
    bool is_seen = false;
    Json row = {{"effect", effect.name}, {"simulated", !evidence.places(k).empty()}};
    double highest = evidence.log_nothing(data)(0);
    for (const Evidence::Place &place : evidence.places(k))
      highest = std::max(highest, evidence.log_likelihood(place.hypothesis, data));
    for (const bool above : {false, true}) {
      if ((above ? space.upper(k) : space.lower(k)) == 0. || evidence.places(k).empty())
        continue;
      const std::string side = above ? "above" : "below";
      const auto seen = detectable(evidence, k, above, findings.threshold, seed);
      is_seen = is_seen || seen;
      row["detectable " + side] = seen ? Json(amplitude_of(effect, *seen)) : Json(nullptr);
      double bound = 0.;
      for (const Evidence::Place &place : evidence.places(k))
        if ((place.amplitude > 0.) == above && std::abs(place.amplitude) > std::abs(bound) &&
            evidence.log_likelihood(place.hypothesis, data) > highest - fall)
          bound = place.amplitude;
      row[above ? "upper bound" : "lower bound"] = amplitude_of(effect, bound);
    }
    row["detectable"] = is_seen;
    rows.push_back(row);
  }
  return rows;
}

Json describe_fingerprints(const Evidence &evidence)
{
  const FactorSpace &space = evidence.space();
  Json rows = Json::array(), strengths = Json::object(), names = Json::array();
  std::vector<Eigen::VectorXd> changes;
  for (std::size_t k = 0; k < space.n_effects(); ++k) {
    const auto &places = evidence.places(k);
    if (places.empty())
      continue;
    const Factor &effect = space.effect(k);
    for (const Evidence::Place &place : places)
      strengths[effect.name].push_back({amplitude_of(effect, place.amplitude),
                                        evidence.change(place.hypothesis.prediction).norm()});
    const Evidence::Place &last = places.back();
    Json change = Json::array(), error = Json::array();
    for (const Target::Part &part : evidence.target().experiments()) {
      const Eigen::VectorXd moved =
          (values_of(part, last.hypothesis.prediction.mean) - part.emulator.base_mean())
              .cwiseQuotient(part.emulator.base_deviation());
      for (const double value : moved) {
        change.push_back(value);
        error.push_back(std::sqrt(part.of(last.hypothesis.prediction.leverage).mean()));
      }
    }
    rows.push_back({{"effect", effect.name},
                    {"amplitude", amplitude_of(effect, last.amplitude)},
                    {"change", change},
                    {"error", error}});
    names.push_back(effect.name);
    changes.push_back(evidence.change(last.hypothesis.prediction));
  }
  Json cosines = Json::array();
  for (const Eigen::VectorXd &a : changes) {
    Json row = Json::array();
    for (const Eigen::VectorXd &b : changes)
      row.push_back(a.dot(b) / std::max(a.norm() * b.norm(), 1e-300));
    cosines.push_back(row);
  }
  return {{"fingerprints", rows},
          {"strengths", strengths},
          {"similarity", {{"effects", names}, {"cosines", cosines}}}};
}

Fitted fit_to(const Target &target, const EffectPositions &effects,
              const Eigen::VectorXd &nuisances)
{
  const Target::Prediction prediction = target.predict(effects);
  const Eigen::VectorXd mean = prediction.mean + prediction.gradient * nuisances;
  Fitted result;
  for (const Target::Part &part : target.experiments()) {
    const MeasuredExperiment &measured = part.measured;
    const Eigen::VectorXd values = values_of(part, mean), unit = part.emulator.base_deviation();
    // Variances in those of a run of the base model.
    const Eigen::VectorXd growth =
        part.emulator.growth(part.rotation.transpose().cwiseAbs2() * part.of(prediction.scatter));
    const double error = part.of(prediction.leverage).mean();
    for (Eigen::Index c = 0; c < values.size(); ++c)
      result.push_back({measured.points[static_cast<std::size_t>(c)], measured.value(c), values(c),
                        (measured.value(c) - values(c)) / unit(c),
                        std::max(part.point_ratio(c), growth(c)) / measured.repeats(c) + error +
                            part.tolerance(c) * part.tolerance(c),
                        unit(c) * std::sqrt(growth(c))});
  }
  return result;
}

Json describe_envelopes(const Target &target, const Fitted &before,
                        const std::optional<Fitted> &after, const double level)
{
  Json rows = Json::array();
  for (const Target::Part &part : target.experiments()) {
    const boost::math::students_t t(std::max(1., part.emulator.degrees_of_freedom()));
    for (Eigen::Index c = 0; c < part.measured.value.size(); ++c) {
      const FittedPoint &point = before[rows.size()];
      const double deviation = point.deviation / std::sqrt(point.variance);
      const double p =
          std::min(1., static_cast<double>(before.size()) * 2. *
                           boost::math::cdf(boost::math::complement(t, std::abs(deviation))));
      Json row = name_of_point(point.point);
      row["measured"] = point.measured;
      row["measured deviation"] = part.measured.deviation(c);
      row["repeats"] = part.measured.repeats(c);
      row["base"] = part.emulator.base_mean()(c);
      row["base deviation"] = part.emulator.base_deviation()(c);
      row["deviation"] = deviation;
      row["p"] = p;
      row["flagged"] = p <= level;
      if (after) {
        row["after"] = (*after)[rows.size()].model;
        row["after deviation"] = (*after)[rows.size()].scatter;
      }
      rows.push_back(row);
    }
  }
  return rows;
}

Json describe_gap(const Fitted &before, const std::optional<Fitted> &after)
{
  const double first = gap(before);
  Json table = {{"cells", before.size()}, {"gap before", first}};
  if (after) {
    const double left = gap(*after);
    table["gap after"] = left;
    table["shrink"] = first > 0. ? Json(1. - left / first) : Json(nullptr);
  }
  return table;
}

Json decisive_points(const Fitted &first, const Fitted &second)
{
  constexpr std::size_t most = 12;
  std::vector<std::pair<double, Json>> rows;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const FittedPoint &a = first[i], &b = second[i];
    const double favours = 0.5 * (std::pow(b.deviation, 2) - std::pow(a.deviation, 2)) / a.variance;
    Json row = name_of_point(a.point);
    row["log likelihood ratio"] = favours;
    row["measured"] = a.measured;
    row["first"] = a.model;
    row["second"] = b.model;
    rows.emplace_back(std::abs(favours), row);
  }
  return largest_first(std::move(rows), most);
}

} // namespace eunoe::discovery
