#include <eunoe/discovery/stages/held_out.h>
#include <eunoe/discovery/stages/stages.h>
#include <eunoe/discovery/statistics/random_stream.h>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

namespace {

Eigen::VectorXd mean_of(const Eigen::MatrixXd &rows)
{
  return rows.colwise().mean().transpose();
}

Eigen::VectorXd resampled_mean(const Eigen::MatrixXd &rows, RandomStream &random)
{
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(rows.cols());
  for (Eigen::Index r = 0; r < rows.rows(); ++r)
    mean += rows.row(static_cast<Eigen::Index>(random.index(static_cast<std::size_t>(rows.rows()))))
                .transpose() /
            static_cast<double>(rows.rows());
  return mean;
}

/// Noise of the data's means, with the correlations that runs show.
Eigen::VectorXd data_jitter(const HeldOut &held_out, RandomStream &random)
{
  const Eigen::MatrixXd rows = centred(held_out.before);
  const auto number = static_cast<Eigen::Index>(std::max(1., held_out.repeats.mean() + 0.5));
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(rows.cols());
  for (Eigen::Index k = 0; k < number; ++k)
    sum += rows.row(static_cast<Eigen::Index>(random.index(static_cast<std::size_t>(rows.rows()))))
               .transpose() /
           static_cast<double>(number);
  return sum.cwiseProduct(held_out.deviation);
}

/// Position of the data between the two models: 0 at the base model, 1 at the chosen one. Below one
/// half the discrepancy grows.
struct Progress
{
  double value = 0., error = 1e300;
};

Progress progress(const HeldOut &held_out, const Prediction &base, const Prediction &chosen)
{
  const Eigen::VectorXd change = chosen.mean - base.mean;
  const Eigen::MatrixXd scatter = centred(base.runs), scatter_after = centred(chosen.runs);
  const auto m = static_cast<double>(scatter.rows()), n = static_cast<double>(scatter_after.rows());
  const double noise =
      scatter.squaredNorm() / (m - 1.) / m + scatter_after.squaredNorm() / (n - 1.) / n;
  const double square = change.squaredNorm() - noise;
  if (square <= 0.)
    return {};
  const double along = (scatter * change).squaredNorm() / (m - 1.);
  const double ratio = std::max(0.3, held_out.deviation.cwiseAbs2().mean());
  const double variance = along * (ratio / held_out.repeats.mean() + 1. / m) +
                          (base.uncertainty.transpose() * change).squaredNorm();
  // The base runs' own noise is in both factors.
  const double bias = scatter.squaredNorm() / (m - 1.) / m;
  return {(change.dot(held_out.data - base.mean) - bias) / square, std::sqrt(variance) / square};
}

Table quantiles(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  return {at(0.025), at(0.975)};
}

/// The discrepancy to a model, and its bootstrap draws: of replicates, repeats, nuisances and
/// amplitudes.
struct DiscrepancyDraws
{
  Discrepancy discrepancy;
  std::vector<double> values;
};

/// Discrepancies of both models, with the same draws of the data.
std::pair<DiscrepancyDraws, DiscrepancyDraws> draw_discrepancies(const HeldOut &held_out,
                                                                 const Prediction &base,
                                                                 const Prediction &chosen,
                                                                 const std::uint32_t seed)
{
  constexpr int n_draws = 999;
  RandomStream random(seed, 2);
  const Eigen::VectorXd noise = noise_variance(held_out, base),
                        noise_after = noise_variance(held_out, chosen);
  std::pair<DiscrepancyDraws, DiscrepancyDraws> result;
  result.first.discrepancy = discrepancy(held_out.data - base.mean, noise);
  result.second.discrepancy = discrepancy(held_out.data - chosen.mean, noise_after);
  for (int d = 0; d < n_draws; ++d) {
    const Eigen::VectorXd data = held_out.data + data_jitter(held_out, random);
    const Eigen::VectorXd shifts = random.normals(1, base.uncertainty.cols()).row(0).transpose();
    const auto drawn = [&](const Prediction &p, const Eigen::VectorXd &variance) {
      const Eigen::VectorXd model =
          p.mean - mean_of(p.runs) + resampled_mean(p.runs, random) + p.uncertainty * shifts;
      // The draw has the noise twice: the real one and its own.
      return discrepancy(data - model, 2. * variance).value;
    };
    result.first.values.push_back(drawn(base, noise));
    result.second.values.push_back(drawn(chosen, noise_after));
  }
  return result;
}

Table compare(const HeldOut &held_out, const Prediction &base, const Prediction &chosen,
              const std::uint32_t seed)
{
  const auto [before, after] = draw_discrepancies(held_out, base, chosen, seed);
  std::vector<double> shrinks;
  for (std::size_t d = 0; d < before.values.size(); ++d) {
    const double b = before.values[d], a = after.values[d];
    shrinks.push_back(b > 0. ? 1. - a / b : a > 0. ? -1e3 : 0.);
  }
  return {{"cells", held_out.points.size()},
          {"gap before", before.discrepancy.value},
          {"deviation before", before.discrepancy.before_correction},
          {"gap after", after.discrepancy.value},
          {"deviation after", after.discrepancy.before_correction},
          {"shrink", before.discrepancy.value > 0.
                         ? Table(1. - after.discrepancy.value / before.discrepancy.value)
                         : Table(nullptr)},
          {"gap before interval", quantiles(before.values)},
          {"gap after interval", quantiles(after.values)},
          {"shrink interval", quantiles(shrinks)},
          {"p of the base model", p_of_held_out(held_out, base, seed)},
          {"p of the chosen model", p_of_held_out(held_out, chosen, seed)}};
}

Table compare_base(const HeldOut &held_out, const Prediction &base, const std::uint32_t seed)
{
  const Discrepancy before = discrepancy(held_out.data - base.mean, noise_variance(held_out, base));
  return {{"cells", held_out.points.size()},
          {"gap before", before.value},
          {"deviation before", before.before_correction},
          {"p of the base model", p_of_held_out(held_out, base, seed)}};
}

/// Relative standard error of fitted amplitudes, root mean square.
double amplitude_error(const StudyState &study, const Findings &findings, const Fit &fit)
{
  const double deviations = 2. * std::sqrt(findings.null_distribution.direction_limit);
  double square = 0.;
  for (std::size_t k = 0; k < fit.effects.size(); ++k) {
    const Interval interval = amplitude_interval(study, findings, fit, k);
    const double size = std::abs(fit.position(static_cast<Eigen::Index>(k)));
    const double error = (interval.upper - interval.lower) / deviations;
    square += std::pow(size > 0. ? error / size : 1., 2) / static_cast<double>(fit.effects.size());
  }
  return std::sqrt(square);
}

Table describe_points(const HeldOut &held_out)
{
  const auto spread = [](const Eigen::MatrixXd &rows, Eigen::Index c) {
    return std::sqrt(centred(rows).col(c).squaredNorm() / static_cast<double>(rows.rows() - 1));
  };
  Table rows = Table::array();
  for (std::size_t k = 0; k < held_out.points.size(); ++k) {
    const auto c = static_cast<Eigen::Index>(k);
    const MeasuredPoint &point = held_out.points[k];
    Table row = {{"experiment", point.point.experiment},
                 {"observable", point.point.observable},
                 {"index", point.point.index},
                 {"measured", point.value},
                 {"measured deviation", point.standard_deviation},
                 {"repeats", point.repeats},
                 {"base", held_out.before.col(c).mean() * held_out.scale(c)},
                 {"base deviation", spread(held_out.before, c) * held_out.scale(c)}};
    if (held_out.after.rows() > 1) {
      row["after"] = held_out.after.col(c).mean() * held_out.scale(c);
      row["after deviation"] = spread(held_out.after, c) * held_out.scale(c);
    }
    rows.push_back(row);
  }
  return rows;
}

/// Result of the validation of a model on held-out data.
struct Validation
{
  Table table;
  bool shrinks = false, does_not_shrink = false, is_bad_fit = false;
  /// Whether more runs could change that.
  bool is_in_doubt = false;

  bool refutes() const { return does_not_shrink || is_bad_fit; }
};

/// @param times multiplies the numbers of runs in the study's options
Validation validate(StudyState &study, const Findings &findings, const Fit &fit,
                    const unsigned int times)
{
  Validation result;
  const HeldOut held_out = make_held_out(study, study.amplitudes(fit.effects, fit.position), times);
  if (held_out.points.empty()) {
    result.table = {{"result", "too few runs of the held-out experiments came to their end"}};
    return result;
  }
  const Prediction base = predict(study, held_out, held_out.before, fit_model(study, {}), 0.);
  Table &table = result.table;
  if (held_out.after.rows() < 3) {
    table = compare_base(held_out, base, study.options.seed);
    table["result"] =
        fit.effects.empty() ? "base model only" : "runs of the model with the effect failed";
  } else {
    const Prediction chosen =
        predict(study, held_out, held_out.after, fit, amplitude_error(study, findings, fit));
    table = compare(held_out, base, chosen, study.options.seed);
    // One standard error below one half: a discrepancy that really shrinks is rarely so unlucky.
    const Progress between = progress(held_out, base, chosen);
    const bool informative = between.error < 0.5;
    const double p = table["p of the chosen model"].get<double>();
    result.does_not_shrink = informative && between.value < 0.5 - between.error;
    result.is_bad_fit = p <= findings.decision.p_of_bad_held_out;
    result.shrinks = informative && !result.refutes();
    result.is_in_doubt = p <= findings.decision.p_of_doubtful_held_out ||
                         (informative && between.value < 0.5 + between.error);
    table["position between the models"] = informative ? Table(between.value) : Table(nullptr);
    table["standard error of the position"] = informative ? Table(between.error) : Table(nullptr);
    const std::string end =
        findings.verdict == Verdict::off_catalogue ? "" : ": the name is withdrawn";
    table["result"] = result.does_not_shrink ? "the gap does not shrink" + end
                      : result.is_bad_fit    ? "the model does not describe them" + end
                      : informative          ? "the gap shrinks"
                                             : "held-out data cannot tell the two models apart";
  }
  table["envelopes"] = describe_points(held_out);
  return result;
}

/// Validates a model, and again with more runs where the first refute it or nearly do, because few
/// runs give a poor estimate of a covariance.
Validation validate(StudyState &study, const Findings &findings, const Fit &fit)
{
  constexpr unsigned int more = 3;
  const Validation first = validate(study, findings, fit, 1);
  const std::uint64_t needed =
      more * held_out_runs(study.data, study.options, study.nuisances.size());
  return first.is_in_doubt && needed <= study.archive.remaining()
             ? validate(study, findings, fit, more)
             : first;
}

/// Validates the likeliest members of a tie, and removes those that the held-out data refute. If
/// one member is left and its discrepancy shrinks, it is named. If none is left, the verdict is
/// withdrawn.
Validation validate_tie(StudyState &study, Findings &findings)
{
  constexpr std::size_t most = 4;
  Table rows = Table::array();
  std::vector<ScoredModel> left;
  std::vector<EffectSet> refuted;
  std::vector<Validation> validations, of_left;
  for (std::size_t k = 0; k < findings.tie.size(); ++k) {
    const ScoredModel &member = findings.tie[k];
    if (k >= most) {
      left.push_back(member);
      continue;
    }
    validations.push_back(validate(study, findings, member.fit));
    const Validation &validation = validations.back();
    rows.push_back({{"effects", name_of(study, member.fit.effects)},
                    {"p", validation.table.value("p of the chosen model", Table(nullptr))},
                    {"result", validation.table["result"]}});
    if (validation.refutes()) {
      refuted.push_back(member.fit.effects);
    } else {
      left.push_back(member);
      of_left.push_back(validation);
    }
  }
  Validation result = validations.front();
  findings.withdrawn = left.empty();
  if (!of_left.empty() && (left.size() >= 2 || of_left.front().shrinks)) {
    result = of_left.front();
    findings.chosen = left.front();
    findings.p_fit = p_of_fit(findings, findings.chosen.fit);
    findings.verdict = left.size() == 1 ? Verdict::named : Verdict::tie;
    findings.tie = left;
    findings.refuted = refuted;
    compute_confidence(findings);
  }
  result.table["members of the tie"] = rows;
  return result;
}

} // namespace

Table stage_validate(StudyState &study, Findings &findings)
{
  if (study.data.held_out.empty())
    return {{"result", "no held-out data"}};
  study.archive.set_aside(0);
  if (findings.verdict == Verdict::tie)
    return validate_tie(study, findings).table;
  const Validation validation = validate(study, findings, findings.chosen.fit);
  findings.withdrawn = validation.refutes();
  return validation.table;
}

} // namespace eunoe::discovery
