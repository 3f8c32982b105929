#include <eunoe/discovery/stages/places.h>
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

/// Sets of as many effects as the chosen one, without those that were refuted. Other sizes were
/// ruled out by the stages fit and iterate, which says nothing of "something else".
std::vector<const Scored *> rivals(const Findings &findings)
{
  std::vector<const Scored *> result;
  for (const Scored &model : findings.posterior.models)
    if (model.fit.effects.size() == findings.chosen.fit.effects.size() &&
        std::find(findings.refuted.begin(), findings.refuted.end(), model.fit.effects) ==
            findings.refuted.end())
      result.push_back(&model);
  return result;
}

/// Takes a part of all confidences and shares it out by their fourth roots. What was not expected
/// befalls whatever is likely enough to be looked at: the second of a hundred to one is right more
/// often than once in a hundred.
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

void settle_confidence(Findings &findings)
{
  double alike = 0.;
  for (const Scored *model : rivals(findings))
    alike += model->probability;
  findings.off_catalogue = findings.posterior.off_catalogue;
  const double share = alike > 0. ? (1. - findings.off_catalogue) / alike : 0.;
  findings.confidence.assign(findings.posterior.inclusion.size(), 0.);
  for (const Scored *model : rivals(findings))
    for (const std::size_t k : model->fit.effects)
      findings.confidence[k] += model->probability * share;
  allow_for_surprise(findings.decision.surprise, findings.confidence);
}

void decide(Findings &findings)
{
  const Decision &decision = findings.decision;
  settle_confidence(findings);
  double alike = 0., sum = 0.;
  for (const Scored *model : rivals(findings))
    alike += model->probability;
  findings.tie.clear();
  for (const Scored *model : rivals(findings)) {
    if (sum < decision.credible * alike)
      findings.tie.push_back(*model);
    sum += model->probability;
  }
  if (findings.off_catalogue > decision.off_catalogue || findings.p_fit < decision.p_of_bad_fit)
    findings.verdict = Verdict::off_catalogue;
  else
    findings.verdict = findings.tie.size() == 1 ? Verdict::named : Verdict::tie;
}

Table describe_remainder(const Workbench &bench, const Findings &findings)
{
  const Fit &fit = findings.chosen.fit;
  Table rows = Table::array();
  const Response response = bench.response_of_columns(fit.effects);
  const Eigen::VectorXd model = bench.measured(response.origin() + response.change(fit.position));
  const Eigen::VectorXd errors = cell_errors(bench);
  for (std::size_t c = 0; c < bench.cells.size(); ++c) {
    const auto k = static_cast<Eigen::Index>(c);
    const double z = (bench.value(k) - model(k)) / bench.modes.deviations()(k) / errors(k);
    const double p = findings.reference.p_cell(z);
    if (p <= bench.options.level)
      rows.push_back({{"experiment", bench.cells[c].experiment},
                      {"observable", bench.cells[c].observable},
                      {"index", bench.cells[c].index},
                      {"deviation", z},
                      {"p", p}});
  }

  // The data's whole deviation from the base model beside each fingerprint.
  const Fit base = fit_model(bench, {});
  const Eigen::VectorXd error = bench.misfit.variance(base.leverage).cwiseSqrt();
  const Eigen::VectorXd deviation = base.remainder.cwiseQuotient(error);
  std::vector<std::pair<double, std::string>> family;
  for (std::size_t k = 0; k < bench.effects.size(); ++k) {
    const Fit alone = fit_model(bench, {k});
    const Response single = bench.response({k});
    const Eigen::VectorXd change = single.change(alone.position).cwiseQuotient(error);
    if (change.norm() > 0.)
      family.emplace_back(deviation.dot(change) / deviation.norm() / change.norm(),
                          bench.effects[k].name);
  }
  std::stable_sort(family.begin(), family.end(),
                   [](const auto &a, const auto &b) { return a.first > b.first; });
  Table similar = Table::array();
  for (std::size_t k = 0; k < std::min<std::size_t>(3, family.size()); ++k)
    similar.push_back(
        {{"effect", family[k].second}, {"mechanism", ""}, {"cosine", family[k].first}});
  for (auto &row : similar)
    for (const Factor &effect : bench.effects)
      if (effect.name == row["effect"].get<std::string>())
        row["mechanism"] = effect.mechanism;
  return {{"closest model", name_of(bench, fit.effects)},
          {"p of its fit", findings.p_fit},
          {"cells that deviate from it", rows},
          {"resembles", similar}};
}

Table describe_envelopes(const Workbench &bench, const Findings &findings)
{
  const Fit &fit = findings.chosen.fit;
  const Response response = bench.response_of_columns(fit.effects);
  const Eigen::VectorXd after = bench.measured(response.origin() + response.change(fit.position));
  const auto spread = [&](const std::vector<RunSet> &sets, const Eigen::Index c) {
    double mean = 0., square = 0.;
    for (const RunSet &set : sets)
      mean += set.values(bench.column_of_cell[static_cast<std::size_t>(c)]) /
              static_cast<double>(sets.size());
    for (const RunSet &set : sets)
      square += std::pow(set.values(bench.column_of_cell[static_cast<std::size_t>(c)]) - mean, 2);
    return std::pair<double, double>(
        mean, std::sqrt(square / std::max(1., static_cast<double>(sets.size()) - 1.)));
  };
  const auto found = bench.runs.find(near_amplitudes(bench, fit.effects, fit.position));
  const bool has_runs =
      !fit.effects.empty() && found != bench.runs.end() && found->second.size() > 2;
  Table rows = Table::array();
  for (std::size_t k = 0; k < bench.cells.size(); ++k) {
    const auto c = static_cast<Eigen::Index>(k);
    const auto [base, base_spread] = spread(bench.base(), c);
    Table row = {{"experiment", bench.cells[k].experiment},
                 {"observable", bench.cells[k].observable},
                 {"index", bench.cells[k].index},
                 {"measured", bench.value(c)},
                 {"measured deviation", bench.deviation(c)},
                 {"repeats", bench.repeats(c)},
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

Gap gap(const Eigen::VectorXd &deviation, const Eigen::VectorXd &noise_variance)
{
  const double square = deviation.squaredNorm() / static_cast<double>(deviation.size());
  return {std::sqrt(std::max(0., square - noise_variance.mean())), std::sqrt(square)};
}

} // namespace eunoe::discovery
