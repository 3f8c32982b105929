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

/// Runs of each effect at both amplitudes, so that there are this many in all.
void ask_fingerprints(Workbench &bench, const unsigned int number)
{
  std::vector<Workbench::Order> orders;
  Eigen::VectorXd position(1);
  for (std::size_t k = 0; k < bench.effects.size(); ++k)
    for (const double level : levels(bench.effects[k])) {
      position(0) = level;
      orders.push_back({bench.amplitudes({k}, position), number});
    }
  bench.ask(orders);
}

void make_fingerprints(Workbench &bench)
{
  ask_fingerprints(bench, bench.options.screen_runs);

  // An effect of which no run came to its end gets another chance, weaker.
  std::vector<Workbench::Order> orders;
  Eigen::VectorXd position(1);
  for (std::size_t k = 0; k < bench.effects.size(); ++k)
    if (!is_simulated(bench, k)) {
      position(0) = 0.5 * levels(bench.effects[k]).front();
      orders.push_back({bench.amplitudes({k}, position), bench.options.screen_runs});
    }
  bench.ask(orders);
  std::size_t n_simulated = 0;
  for (std::size_t k = 0; k < bench.effects.size(); ++k)
    if (is_simulated(bench, k))
      ++n_simulated;
    else
      bench.notes.push_back("The effect " + bench.effects[k].name +
                            " could not be simulated: all its runs failed, or the budget was "
                            "used up. It is not looked for.");
  if (n_simulated == 0)
    throw UserError("No effect of the catalogue could be simulated: raise the budget, or see why "
                    "runs fail.");
}

/// Runs with which a study in doubt looks again: of the base model, on either side of a nuisance,
/// and at each amplitude of an effect, in all.
struct SecondLook
{
  unsigned int base, nuisance, fingerprint;

  explicit SecondLook(const StudyOptions &options)
      : base(more(options.null_runs)), nuisance(more(options.nuisance_runs)),
        fingerprint(more(options.screen_runs))
  {
  }

  /// Whether the budget has room for it, and for what follows if it finds something.
  bool fits(const Workbench &bench) const
  {
    const StudyOptions &o = bench.options;
    const std::uint64_t sets =
        base - o.null_runs + 2ull * bench.nuisances.size() * (nuisance - o.nuisance_runs) +
        2ull * bench.effects.size() * (fingerprint - o.screen_runs) +
        static_cast<std::uint64_t>(o.n_leaders) * o.confirm_runs + o.fit_runs;
    return sets * bench.experiments.size() <= bench.archive.remaining();
  }

private:
  static unsigned int more(unsigned int number) { return (5 * number + 1) / 2; }
};

/// Tests the base model with all that is known so far.
/// @param share of the level that this look may spend
Table look(Workbench &bench, Findings &findings, const double share)
{
  std::vector<Response> responses;
  for (std::size_t k = 0; k < bench.effects.size(); ++k)
    responses.push_back(bench.response_of_modes({k}));
  findings.reference = make_reference(bench, responses);
  findings.evidence = evidence_against_base(bench, responses);
  const double p = findings.reference.p_joint(findings.evidence, true);
  const double p_of_look = findings.decision.safety_of_p * p / share;
  if (p_of_look < findings.p_detected) {
    findings.p_detected = p_of_look;
    findings.p_is_bound = p <= findings.reference.least_p();
  }
  findings.detected = findings.p_detected <= bench.options.level;
  return {{"sets of runs of the base model", bench.base().size()},
          {"p", p},
          {"share of the level", share},
          {"largest gain", findings.evidence.gain},
          {"p of largest gain", findings.reference.p_gain(findings.evidence.gain)},
          {"p of distance", findings.reference.p_distance(findings.evidence.distance)},
          {"p of largest deviation", findings.reference.p_cell(findings.evidence.cell)}};
}

/// How clearly the data would show an effect: its change in standard errors, with the share that
/// noise explains taken off.
double clearness(const Workbench &bench, const Response &response, const Eigen::VectorXd &position)
{
  const Eigen::VectorXd weight = bench.misfit.variance(response.origin_leverage()).cwiseInverse();
  const Eigen::VectorXd change = response.change(position);
  const double square = change.dot(weight.cwiseProduct(change));
  const double leverage = response.change_leverage(position), noise = leverage * weight.sum();
  // What noise alone makes now and then is no fingerprint: three standard deviations above it are.
  constexpr double clear = 3.;
  if (square < noise + clear * std::sqrt(2.) * leverage * weight.norm())
    return 0.;
  return std::sqrt(square - noise);
}

/// The smallest amplitude (scales) that is detected with 80 % power; beyond the runs so far the
/// change is taken to grow in proportion.
double detectable(const Workbench &bench, const Response &response, const double end,
                  const double limit)
{
  constexpr double quantile_of_power = 0.8416;
  constexpr int steps = 60;
  const double needed = std::sqrt(limit) + quantile_of_power;
  Eigen::VectorXd position(1);
  for (int step = 1; step <= steps; ++step) {
    position(0) = end * step / steps;
    if (clearness(bench, response, position) >= needed)
      return position(0);
  }
  const double last = clearness(bench, response, position);
  return last > 0. ? end * needed / last : std::numeric_limits<double>::infinity();
}

Table describe_effect(const Workbench &bench, const Findings &findings, const std::size_t k)
{
  const Factor &effect = bench.effects[k];
  const Response response = bench.response({k});
  const Bounds range = bounds(bench, {k}, response);
  const auto amplitude = [&](double u) { return effect.null_value + u * effect.scale; };
  const auto within = [&](double u) {
    return std::isfinite(u) && amplitude(u) <= effect.upper + 1e-12 * effect.scale &&
           amplitude(u) >= effect.lower - 1e-12 * effect.scale;
  };
  Table row = {{"effect", effect.name}, {"simulated", is_simulated(bench, k)}};
  if (!is_simulated(bench, k))
    return row;
  const Fit fit = fit_model(bench, {k});
  const Fit base = fit_model(bench, {});
  row["amplitude"] = amplitude(fit.position(0));
  row["gain"] = base.deviance - fit.deviance;
  row["p"] = findings.reference.p_gain(base.deviance - fit.deviance);
  row["correlation of paired seeds"] = bench.seed_correlation({k});
  const double limit = findings.reference.gain_limit(bench.options.level);
  bool seen = false;
  for (const double end : {range.upper(0), range.lower(0)}) {
    if (end == 0.)
      continue;
    const double u = detectable(bench, response, end, limit);
    row[end > 0. ? "detectable above" : "detectable below"] =
        within(u) ? Table(amplitude(u)) : Table(nullptr);
    seen = seen || within(u);
  }
  row["detectable"] = seen;
  // One-sided bounds at the level: 2.706 and 3.841 are chi-square's 90 and 95 % points.
  const Interval interval =
      profile_interval(bench, fit, 0, findings.reference.direction_limit * 2.706 / 3.841);
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
Table cosines(const Workbench &bench)
{
  std::vector<Eigen::VectorXd> changes;
  std::vector<double> norms;
  Table names = Table::array();
  for (std::size_t k = 0; k < bench.effects.size(); ++k) {
    if (!is_simulated(bench, k))
      continue;
    const Response response = bench.response({k});
    const Bounds range = bounds(bench, {k}, response);
    const Eigen::VectorXd end =
        (range.upper(0) > -range.lower(0) ? range.upper : range.lower) / 1.5;
    names.push_back(bench.effects[k].name);
    changes.push_back(response.change(end).cwiseQuotient(
        bench.misfit.variance(response.origin_leverage()).cwiseSqrt()));
    norms.push_back(clearness(bench, response, end));
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

Table stage_screen(Workbench &bench, Findings &findings)
{
  const Decision &decision = findings.decision;
  make_fingerprints(bench);
  settle_chaos(bench);
  const SecondLook second(bench.options);
  const bool may_look_again = bench.options.second_look && second.fits(bench);
  const double share = may_look_again ? decision.share_of_first_look : 1.;
  Table looks = Table::array();
  looks.push_back(look(bench, findings, share));
  if (may_look_again && !findings.detected &&
      looks.back().at("p").get<double>() <= decision.p_of_second_look)
  {
    ask_base_runs(bench, second.base, second.nuisance);
    ask_fingerprints(bench, second.fingerprint);
    settle_noise(bench);
    settle_base_reference(bench, findings);
    looks.push_back(look(bench, findings, 1. - share));
  }

  Table table = {{"p", findings.p_detected},
                 {"detected", findings.detected},
                 {"looks", looks},
                 {"largest gain", findings.evidence.gain},
                 {"p of largest gain", findings.reference.p_gain(findings.evidence.gain)},
                 {"gain needed", findings.reference.gain_limit(bench.options.level)},
                 {"gain along one direction", findings.reference.direction_limit}};
  table["effects"] = Table::array();
  for (std::size_t k = 0; k < bench.effects.size(); ++k)
    table["effects"].push_back(describe_effect(bench, findings, k));
  table["similarity"] = cosines(bench);
  return table;
}

} // namespace eunoe::discovery
