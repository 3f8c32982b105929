#include <eunoe/core/sha256.h>
#include <eunoe/discovery/stages/held_out.h>
#include <eunoe/discovery/stages/stages.h>

#include <algorithm>

namespace eunoe::discovery {

namespace {

/// A hash of all that decides what a stage finds.
std::string study_key(const StudyOptions &o, const MeasuredData &data,
                      const std::vector<Factor> &factors)
{
  Table all = {o.level,
               o.null_runs,
               o.nuisance_runs,
               o.screen_runs,
               o.confirm_runs,
               o.confirm_rounds,
               o.n_leaders,
               o.fit_runs,
               o.validate_runs,
               o.budget,
               o.max_effects,
               o.seed,
               o.further_experiments,
               o.model_tolerance,
               o.second_look,
               o.common_random_numbers,
               o.confirm,
               o.bootstrap};
  for (const auto *cells : {&data.fit, &data.held_out})
    for (const MeasuredCell &cell : *cells)
      all.push_back({cell.cell.experiment, cell.cell.observable, cell.cell.index, cell.value,
                     cell.standard_deviation, cell.repeats});
  for (const Factor &f : factors)
    all.push_back({f.name, static_cast<int>(f.kind), f.null_value, f.scale, f.lower, f.upper,
                   static_cast<int>(f.sign), f.prior_deviation});
  return sha256(all.dump());
}

/// Runs stages one after the other, each from its own or an earlier start's runs.
class Course
{
public:
  Course(Workbench &bench, StageStore &store, std::string key)
      : bench(bench), store(store), key(std::move(key))
  {
  }

  template <typename Stage>
  void run(const std::string &name, const Stage &stage)
  {
    const auto kept = store.load(name);
    const bool usable = kept && kept->value("key", "") == key;
    if (usable)
      bench.archive.absorb(kept->at("runs"));
    const std::uint64_t before = bench.archive.n_requests();
    tables[name] = stage();
    tables[name]["runs"] = bench.archive.n_requests() - before;
    store.save(name, {{"key", key}, {"table", tables[name]}, {"runs", bench.archive.take_new()}});
    bench.log.line("  " + name + ": " + std::to_string(bench.archive.n_requests() - before) +
                   " runs" + (usable ? ", found from an earlier start" : ""));
  }

  Table tables = Table::object();

private:
  Workbench &bench;
  StageStore &store;
  const std::string key;
};

/// Without anything detected: whether most effects would have been.
void decide_without_detection(const Table &screen, Findings &findings)
{
  double seen = 0., all = 0.;
  for (const auto &row : screen.at("effects")) {
    if (!row.at("simulated").get<bool>())
      continue;
    all += 1.;
    seen += row.at("detectable").get<bool>() ? 1. : 0.;
  }
  findings.verdict = 2. * seen >= all ? Verdict::none : Verdict::underpowered;
  findings.confidence.assign(findings.confidence.size(), 0.);
}

Table candidates(const Workbench &bench, const Findings &findings)
{
  std::vector<std::size_t> order(bench.effects.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    order[k] = k;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return findings.confidence[a] > findings.confidence[b];
  });
  Table rows = Table::array();
  for (const std::size_t k : order) {
    const Factor &effect = bench.effects[k];
    Table row = {{"effect", effect.name},
                 {"confidence", findings.confidence[k]},
                 {"mechanism", effect.mechanism},
                 {"unit", effect.unit},
                 {"source", effect.source}};
    if (findings.detected && is_simulated(bench, k)) {
      const Fit alone = fit_model(bench, {k});
      row["amplitude alone"] = effect.null_value + alone.position(0) * effect.scale;
      row["gain alone"] = fit_model(bench, {}).deviance - alone.deviance;
    }
    rows.push_back(row);
  }
  return rows;
}

Table gaps_on_fit(const Workbench &bench, const Findings &findings)
{
  const auto of = [&](const Fit &fit) {
    const Response response = bench.response_of_columns(fit.effects);
    const Eigen::VectorXd model = bench.measured(response.origin() + response.change(fit.position));
    return gap((bench.value - model).cwiseQuotient(bench.modes.deviations()),
               bench.noise.cell_variance + bench.cell_chaos * response.leverage(fit.position));
  };
  const Gap before = of(fit_model(bench, {}));
  Table table = {{"cells", bench.cells.size()},
                 {"gap before", before.value},
                 {"deviation before", before.before_correction}};
  if (!findings.chosen.fit.effects.empty()) {
    const Gap after = of(findings.chosen.fit);
    table["gap after"] = after.value;
    table["deviation after"] = after.before_correction;
    table["shrink"] = before.value > 0. ? Table(1. - after.value / before.value) : Table(nullptr);
  }
  return table;
}

Table content(Workbench &bench, const Findings &findings, const Table &stages)
{
  Table result = {{"verdict", name_of(findings.verdict)},
                  {"exit code", exit_code(findings.verdict)},
                  {"p of nothing missing", findings.p_detected},
                  {"p of nothing missing is a bound", findings.p_is_bound},
                  {"confidence off catalogue", findings.off_catalogue}};
  result["candidates"] = candidates(bench, findings);
  result["amplitudes"] = describe_amplitudes(bench, findings);
  result["p of the fit"] = findings.p_fit;
  Table ties = Table::array();
  if (findings.verdict == Verdict::tie)
    ties = describe_models(bench, findings.tie);
  result["tie"] = ties;
  result["nuisances"] = Table::array();
  const Eigen::VectorXd estimates =
      nuisance_estimates(bench, findings.chosen.fit.remainder, findings.chosen.fit.leverage);
  for (std::size_t k = 0; k < bench.nuisances.size(); ++k) {
    const Factor &nuisance = bench.nuisances[k];
    const double shift = estimates(static_cast<Eigen::Index>(k));
    result["nuisances"].push_back(
        {{"nuisance", nuisance.name},
         {"value", nuisance.null_value + shift * nuisance.prior_deviation},
         {"prior deviations", shift}});
  }
  result["gaps"] = {{"fit", gaps_on_fit(bench, findings)},
                    {"held-out", stages.value("validate", Table::object())}};
  result["envelopes"] = describe_envelopes(bench, findings);
  result["runs"] = {{"asked for", bench.archive.n_requests()},
                    {"failed", bench.archive.n_failed()},
                    {"budget", bench.options.budget}};
  result["notes"] = bench.notes;
  result["stages"] = stages;
  return result;
}

} // namespace

Discovery discover(const StudyOptions &options, const MeasuredData &data,
                   const std::vector<Factor> &factors, Laboratory &laboratory, StageStore &store,
                   Log &log)
{
  Workbench bench(options, data, factors, laboratory, log);
  Findings findings;
  findings.confidence.assign(bench.effects.size(), 0.);
  bench.archive.set_aside(held_out_runs(data, options, bench.nuisances.size()));
  Course course(bench, store, study_key(options, data, factors));
  course.run("null", [&] { return stage_null(bench); });
  course.run("detect", [&] { return stage_detect(bench, findings); });
  course.run("screen", [&] { return stage_screen(bench, findings); });
  findings.chosen.fit = fit_model(bench, {});
  if (findings.detected) {
    course.run("confirm", [&] { return stage_confirm(bench, findings); });
    course.run("fit", [&] { return stage_fit(bench, findings); });
    course.run("iterate", [&] { return stage_iterate(bench, findings); });
    decide(findings);
  } else {
    decide_without_detection(course.tables["screen"], findings);
  }
  Table separating = Table::array(), remainder = Table::object();
  course.run("validate", [&] { return stage_validate(bench, findings); });
  if (findings.withdrawn)
    findings.verdict = Verdict::off_catalogue;
  if (findings.verdict == Verdict::tie)
    course.run("tie", [&]() -> Table {
      separating = separating_measurements(bench, findings.tie);
      return {{"measurements", separating}};
    });
  if (findings.verdict == Verdict::off_catalogue)
    remainder = describe_remainder(bench, findings);

  Discovery discovery;
  discovery.verdict = findings.verdict;
  discovery.content = content(bench, findings, course.tables);
  discovery.content["measurements that would break the tie"] = separating;
  discovery.content["remainder"] = remainder;
  discovery.n_runs = bench.archive.n_requests();
  const bool has_model = findings.verdict == Verdict::named || findings.verdict == Verdict::tie;
  if (has_model)
    discovery.model_after =
        bench.amplitudes(findings.chosen.fit.effects, findings.chosen.fit.position);
  for (const auto &row : discovery.content["nuisances"])
    discovery.nuisances[row["nuisance"].get<std::string>()] = row["value"].get<double>();
  log.line("Verdict: " + name_of(findings.verdict));
  return discovery;
}

} // namespace eunoe::discovery
