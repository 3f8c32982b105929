#include <eunoe/core/problems.h>
#include <eunoe/discovery/stages/stages.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace eunoe::discovery {

namespace {

/// The two amplitudes of an effect's fingerprint, in scales from its null value.
std::vector<double> levels(const Factor &effect)
{
  const double lower = (effect.lower - effect.null_value) / effect.scale;
  const double upper = (effect.upper - effect.null_value) / effect.scale;
  const bool above = effect.sign != Factor::Sign::below && upper > 0.;
  const bool below = effect.sign != Factor::Sign::above && lower < 0.;
  if (above && below)
    return {std::max(-1., lower), std::min(1., upper)};
  // Both amplitudes within the range, a factor of two apart.
  const double side = above ? 1. : -1., most = std::min(2., above ? upper : -lower);
  return {0.5 * side * most, side * most};
}

/// Runs each effect at both amplitudes until there are this many replicates.
void run_fingerprint_design(StudyState &study, const unsigned int number)
{
  std::vector<DesignPoint> design;
  Eigen::VectorXd position(1);
  for (std::size_t k = 0; k < study.effects.size(); ++k)
    for (const double level : levels(study.effects[k])) {
      position(0) = level;
      design.push_back({study.amplitudes({k}, position), number});
    }
  study.run_design(design);
}

void make_fingerprints(StudyState &study)
{
  run_fingerprint_design(study, study.options.screen_runs);

  // An effect whose runs all failed is tried again at half the amplitude.
  std::vector<DesignPoint> design;
  Eigen::VectorXd position(1);
  for (std::size_t k = 0; k < study.effects.size(); ++k)
    if (!is_simulated(study, k)) {
      position(0) = 0.5 * levels(study.effects[k]).front();
      design.push_back({study.amplitudes({k}, position), study.options.screen_runs});
    }
  study.run_design(design);
  std::size_t n_simulated = 0;
  for (std::size_t k = 0; k < study.effects.size(); ++k)
    if (is_simulated(study, k))
      ++n_simulated;
    else
      study.notes.push_back("The effect " + study.effects[k].name +
                            " could not be simulated: all its runs failed, or the budget was "
                            "used up. It is not looked for.");
  if (n_simulated == 0)
    throw UserError("No effect of the catalogue could be simulated: raise the budget, or see why "
                    "runs fail.");
}

/// Numbers of replicates for the second look, the second test of a study that is in doubt: of the
/// base model, on either side of a nuisance, and at each amplitude of an effect.
struct SecondLook
{
  unsigned int base, nuisance, fingerprint;

  explicit SecondLook(const StudyOptions &options)
      : base(more(options.null_runs)), nuisance(more(options.nuisance_runs)),
        fingerprint(more(options.screen_runs))
  {
  }

  /// Whether the budget has room for it, and for what follows if it finds something.
  bool fits(const StudyState &study) const
  {
    const StudyOptions &o = study.options;
    const std::uint64_t sets =
        base - o.null_runs + 2ull * study.nuisances.size() * (nuisance - o.nuisance_runs) +
        2ull * study.effects.size() * (fingerprint - o.screen_runs) +
        static_cast<std::uint64_t>(o.n_leaders) * o.confirm_runs + o.fit_runs;
    return sets * study.experiments.size() <= study.archive.remaining();
  }

private:
  static unsigned int more(unsigned int number) { return (5 * number + 1) / 2; }
};

/// Tests the base model with all runs so far.
/// @param share of the level for this test (Bonferroni)
Table test_base_model(StudyState &study, Findings &findings, const double share)
{
  std::vector<Emulator> emulators;
  for (std::size_t k = 0; k < study.effects.size(); ++k)
    emulators.push_back(study.emulator_of_modes({k}));
  findings.null_distribution = make_null_distribution(study, emulators);
  findings.statistics = test_statistics(study, emulators);
  const double p = findings.null_distribution.p_joint(findings.statistics, true);
  const double p_of_look = findings.decision.safety_of_p * p / share;
  if (p_of_look < findings.p_detected) {
    findings.p_detected = p_of_look;
    findings.p_is_bound = p <= findings.null_distribution.least_p();
  }
  findings.detected = findings.p_detected <= study.options.level;
  return {{"sets of runs of the base model", study.base().size()},
          {"p", p},
          {"share of the level", share},
          {"largest gain", findings.statistics.gain},
          {"p of largest gain", findings.null_distribution.p_gain(findings.statistics.gain)},
          {"p of distance", findings.null_distribution.p_distance(findings.statistics.distance)},
          {"p of largest deviation",
           findings.null_distribution.p_largest_deviation(findings.statistics.largest_deviation)}};
}

/// Signal-to-noise ratio of an effect: its change in standard errors, with the share that noise
/// explains taken off.
double clearness(const StudyState &study, const Emulator &emulator, const Eigen::VectorXd &position)
{
  const Eigen::VectorXd weight = study.misfit.variance(emulator.origin_leverage()).cwiseInverse();
  const Eigen::VectorXd change = emulator.change(position);
  const double square = change.dot(weight.cwiseProduct(change));
  const double leverage = emulator.change_leverage(position), noise = leverage * weight.sum();
  // A fingerprint must exceed its expectation from noise alone by three standard deviations.
  constexpr double clear = 3.;
  if (square < noise + clear * std::sqrt(2.) * leverage * weight.norm())
    return 0.;
  return std::sqrt(square - noise);
}

/// The smallest amplitude (scales) that is detected with 80 % power; beyond the runs so far the
/// change is taken to grow in proportion.
double detectable(const StudyState &study, const Emulator &emulator, const double end,
                  const double limit)
{
  constexpr double quantile_of_power = 0.8416;
  constexpr int steps = 60;
  const double needed = std::sqrt(limit) + quantile_of_power;
  Eigen::VectorXd position(1);
  for (int step = 1; step <= steps; ++step) {
    position(0) = end * step / steps;
    if (clearness(study, emulator, position) >= needed)
      return position(0);
  }
  const double last = clearness(study, emulator, position);
  return last > 0. ? end * needed / last : std::numeric_limits<double>::infinity();
}

Table describe_effect(const StudyState &study, const Findings &findings, const std::size_t k)
{
  const Factor &effect = study.effects[k];
  const Emulator emulator = study.emulator({k});
  const Bounds range = bounds(study, {k}, emulator);
  const auto amplitude = [&](double u) { return effect.null_value + u * effect.scale; };
  const auto within = [&](double u) {
    return std::isfinite(u) && amplitude(u) <= effect.upper + 1e-12 * effect.scale &&
           amplitude(u) >= effect.lower - 1e-12 * effect.scale;
  };
  Table row = {{"effect", effect.name}, {"simulated", is_simulated(study, k)}};
  if (!is_simulated(study, k))
    return row;
  const Fit fit = fit_model(study, {k});
  const Fit base = fit_model(study, {});
  row["amplitude"] = amplitude(fit.position(0));
  row["gain"] = base.deviance - fit.deviance;
  row["p"] = findings.null_distribution.p_gain(base.deviance - fit.deviance);
  row["correlation of paired seeds"] = study.seed_correlation({k});
  const double limit = findings.null_distribution.gain_limit(study.options.level);
  bool seen = false;
  for (const double end : {range.upper(0), range.lower(0)}) {
    if (end == 0.)
      continue;
    const double u = detectable(study, emulator, end, limit);
    row[end > 0. ? "detectable above" : "detectable below"] =
        within(u) ? Table(amplitude(u)) : Table(nullptr);
    seen = seen || within(u);
  }
  row["detectable"] = seen;
  // One-sided bounds at the level: 2.706 and 3.841 are chi-square's 90 and 95 % points.
  const Interval interval =
      profile_interval(study, fit, 0, findings.null_distribution.direction_limit * 2.706 / 3.841);
  if (range.upper(0) > 0.) {
    row["upper bound"] = amplitude(interval.upper);
    row["upper bound reached"] = !interval.open_above;
  }
  if (range.lower(0) < 0.) {
    row["lower bound"] = amplitude(interval.lower);
    row["lower bound reached"] = !interval.open_below;
  }
  return row;
}

/// Cosines between the changes that effects make, in units of the noise of the comparison.
Table cosines(const StudyState &study)
{
  std::vector<Eigen::VectorXd> changes;
  std::vector<double> norms;
  Table names = Table::array();
  for (std::size_t k = 0; k < study.effects.size(); ++k) {
    if (!is_simulated(study, k))
      continue;
    const Emulator emulator = study.emulator({k});
    const Bounds range = bounds(study, {k}, emulator);
    const Eigen::VectorXd end =
        (range.upper(0) > -range.lower(0) ? range.upper : range.lower) / 1.5;
    names.push_back(study.effects[k].name);
    changes.push_back(emulator.change(end).cwiseQuotient(
        study.misfit.variance(emulator.origin_leverage()).cwiseSqrt()));
    norms.push_back(clearness(study, emulator, end));
  }
  Table matrix = Table::array();
  for (std::size_t a = 0; a < changes.size(); ++a) {
    Table row = Table::array();
    for (std::size_t b = 0; b < changes.size(); ++b) {
      const double product = norms[a] * norms[b];
      if (a == b)
        row.push_back(1.);
      else if (product > 0.)
        row.push_back(std::clamp(changes[a].dot(changes[b]) / product, -1., 1.));
      else
        row.push_back(nullptr);
    }
    matrix.push_back(row);
  }
  return {{"effects", names}, {"cosines", matrix}};
}

} // namespace

Table stage_screen(StudyState &study, Findings &findings)
{
  const DecisionRule &decision = findings.decision;
  make_fingerprints(study);
  estimate_replicate_covariance(study);
  const SecondLook second(study.options);
  const bool may_look_again = study.options.second_look && second.fits(study);
  const double share = may_look_again ? decision.share_of_first_look : 1.;
  Table looks = Table::array();
  looks.push_back(test_base_model(study, findings, share));
  if (may_look_again && !findings.detected &&
      looks.back().at("p").get<double>() <= decision.p_of_second_look)
  {
    run_base_design(study, second.base, second.nuisance);
    run_fingerprint_design(study, second.fingerprint);
    estimate_noise(study);
    make_base_null_distribution(study, findings);
    looks.push_back(test_base_model(study, findings, 1. - share));
  }

  Table table = {{"p", findings.p_detected},
                 {"detected", findings.detected},
                 {"looks", looks},
                 {"largest gain", findings.statistics.gain},
                 {"p of largest gain", findings.null_distribution.p_gain(findings.statistics.gain)},
                 {"gain needed", findings.null_distribution.gain_limit(study.options.level)},
                 {"gain along one direction", findings.null_distribution.direction_limit}};
  table["effects"] = Table::array();
  for (std::size_t k = 0; k < study.effects.size(); ++k)
    table["effects"].push_back(describe_effect(study, findings, k));
  table["similarity"] = cosines(study);
  return table;
}

} // namespace eunoe::discovery
