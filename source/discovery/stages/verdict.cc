#include <eunoe/discovery/stages/design.h>
#include <eunoe/discovery/stages/stages.h>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

std::string name_of(const Verdict verdict)
{
  switch (verdict) {
  case Verdict::none:
    return "none";
  case Verdict::named:
    return "named";
  case Verdict::tie:
    return "tie";
  case Verdict::off_catalogue:
    return "off catalogue";
  case Verdict::underpowered:
    return "underpowered";
  }
  return "";
}

int exit_code(const Verdict verdict)
{
  switch (verdict) {
  case Verdict::none:
    return 0;
  case Verdict::named:
    return 10;
  case Verdict::tie:
    return 11;
  case Verdict::off_catalogue:
    return 12;
  case Verdict::underpowered:
    return 13;
  }
  return 1;
}

namespace {

/// Sets of effects that compete with the chosen one: those of the same size that were not refuted.
/// The stages fit and iterate have decided the size; "off catalogue" is not among them.
std::vector<const ScoredModel *> competing_models(const Findings &findings)
{
  std::vector<const ScoredModel *> result;
  for (const ScoredModel &model : findings.posterior.models)
    if (model.fit.effects.size() == findings.chosen.fit.effects.size() &&
        std::find(findings.refuted.begin(), findings.refuted.end(), model.fit.effects) ==
            findings.refuted.end())
      result.push_back(&model);
  return result;
}

/// Takes a share of all confidences and distributes it by their fourth roots, for errors outside
/// the statistical model: an alternative at odds of one to a hundred is right more often than that.
void allow_for_surprise(const double surprise, std::vector<double> &confidence)
{
  double sum = 0., roots = 0.;
  for (const double value : confidence) {
    sum += value;
    roots += std::pow(value, 0.25);
  }
  if (roots > 0.)
    for (double &value : confidence)
      value = (1. - surprise) * value + surprise * sum * std::pow(value, 0.25) / roots;
}

} // namespace

void compute_confidence(Findings &findings)
{
  double alike = 0.;
  for (const ScoredModel *model : competing_models(findings))
    alike += model->probability;
  findings.off_catalogue = findings.posterior.off_catalogue;
  const double share = alike > 0. ? (1. - findings.off_catalogue) / alike : 0.;
  findings.confidence.assign(findings.posterior.inclusion.size(), 0.);
  for (const ScoredModel *model : competing_models(findings))
    for (const std::size_t k : model->fit.effects)
      findings.confidence[k] += model->probability * share;
  allow_for_surprise(findings.decision.surprise, findings.confidence);
}

void decide(Findings &findings)
{
  const DecisionRule &decision = findings.decision;
  compute_confidence(findings);
  double alike = 0., sum = 0.;
  for (const ScoredModel *model : competing_models(findings))
    alike += model->probability;
  findings.tie.clear();
  for (const ScoredModel *model : competing_models(findings)) {
    if (sum < decision.credible * alike)
      findings.tie.push_back(*model);
    sum += model->probability;
  }
  if (findings.off_catalogue > decision.off_catalogue || findings.p_fit < decision.p_of_bad_fit)
    findings.verdict = Verdict::off_catalogue;
  else
    findings.verdict = findings.tie.size() == 1 ? Verdict::named : Verdict::tie;
}

Table describe_remainder(const StudyState &study, const Findings &findings)
{
  const Fit &fit = findings.chosen.fit;
  Table rows = Table::array();
  const Emulator emulator = study.emulator_of_columns(fit.effects);
  const Eigen::VectorXd model = study.measured(emulator.origin() + emulator.change(fit.position));
  const Eigen::VectorXd errors = standard_errors(study);
  for (std::size_t c = 0; c < study.data_points.size(); ++c) {
    const auto k = static_cast<Eigen::Index>(c);
    const double z = (study.value(k) - model(k)) / study.modes.deviations()(k) / errors(k);
    const double p = findings.null_distribution.p_largest_deviation(z);
    if (p <= study.options.level)
      rows.push_back({{"experiment", study.data_points[c].experiment},
                      {"observable", study.data_points[c].observable},
                      {"index", study.data_points[c].index},
                      {"deviation", z},
                      {"p", p}});
  }

  // Cosine between the data's deviation from the base model and each fingerprint.
  const Fit base = fit_model(study, {});
  const Eigen::VectorXd error = study.misfit.variance(base.leverage).cwiseSqrt();
  const Eigen::VectorXd deviation = base.remainder.cwiseQuotient(error);
  std::vector<std::pair<double, std::string>> family;
  for (std::size_t k = 0; k < study.effects.size(); ++k) {
    const Fit alone = fit_model(study, {k});
    const Emulator single = study.emulator({k});
    const Eigen::VectorXd change = single.change(alone.position).cwiseQuotient(error);
    if (change.norm() > 0.)
      family.emplace_back(deviation.dot(change) / deviation.norm() / change.norm(),
                          study.effects[k].name);
  }
  std::stable_sort(family.begin(), family.end(),
                   [](const auto &a, const auto &b) { return a.first > b.first; });
  Table similar = Table::array();
  for (std::size_t k = 0; k < std::min<std::size_t>(3, family.size()); ++k)
    similar.push_back(
        {{"effect", family[k].second}, {"mechanism", ""}, {"cosine", family[k].first}});
  for (auto &row : similar)
    for (const Factor &effect : study.effects)
      if (effect.name == row["effect"].get<std::string>())
        row["mechanism"] = effect.mechanism;
  return {{"closest model", name_of(study, fit.effects)},
          {"p of its fit", findings.p_fit},
          {"cells that deviate from it", rows},
          {"resembles", similar}};
}

Table describe_envelopes(const StudyState &study, const Findings &findings)
{
  const Fit &fit = findings.chosen.fit;
  const Emulator emulator = study.emulator_of_columns(fit.effects);
  const Eigen::VectorXd after = study.measured(emulator.origin() + emulator.change(fit.position));
  const auto spread = [&](const std::vector<Replicate> &sets, const Eigen::Index c) {
    double mean = 0., square = 0.;
    for (const Replicate &set : sets)
      mean += set.values(study.column_of_point[static_cast<std::size_t>(c)]) /
              static_cast<double>(sets.size());
    for (const Replicate &set : sets)
      square += std::pow(set.values(study.column_of_point[static_cast<std::size_t>(c)]) - mean, 2);
    return std::pair<double, double>(
        mean, std::sqrt(square / std::max(1., static_cast<double>(sets.size()) - 1.)));
  };
  const auto found = study.replicates.find(nearest_design_point(study, fit.effects, fit.position));
  const bool has_runs =
      !fit.effects.empty() && found != study.replicates.end() && found->second.size() > 2;
  Table rows = Table::array();
  for (std::size_t k = 0; k < study.data_points.size(); ++k) {
    const auto c = static_cast<Eigen::Index>(k);
    const auto [base, base_spread] = spread(study.base(), c);
    Table row = {{"experiment", study.data_points[k].experiment},
                 {"observable", study.data_points[k].observable},
                 {"index", study.data_points[k].index},
                 {"measured", study.value(c)},
                 {"measured deviation", study.deviation(c)},
                 {"repeats", study.repeats(c)},
                 {"base", base},
                 {"base deviation", base_spread}};
    if (!fit.effects.empty()) {
      row["after"] = after(c);
      row["after deviation"] = has_runs ? spread(found->second, c).second : base_spread;
    }
    rows.push_back(row);
  }
  return rows;
}

Discrepancy discrepancy(const Eigen::VectorXd &deviation, const Eigen::VectorXd &noise_variance)
{
  const double square = deviation.squaredNorm() / static_cast<double>(deviation.size());
  return {std::sqrt(std::max(0., square - noise_variance.mean())), std::sqrt(square)};
}

} // namespace eunoe::discovery
