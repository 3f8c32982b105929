#include <eunoe/core/sha256.h>
#include <eunoe/discovery/stages/held_out.h>
#include <eunoe/discovery/stages/stages.h>

#include <algorithm>

namespace eunoe::discovery {

namespace {

/// A hash of all that decides the results of a stage.
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
  for (const auto *points : {&data.fit, &data.held_out})
    for (const MeasuredPoint &point : *points)
      all.push_back({point.point.experiment, point.point.observable, point.point.index, point.value,
                     point.standard_deviation, point.repeats});
  for (const Factor &f : factors)
    all.push_back({f.name, static_cast<int>(f.kind), f.null_value, f.scale, f.lower, f.upper,
                   static_cast<int>(f.sign), f.prior_deviation});
  return sha256(all.dump());
}

/// Runs stages one after the other. The runs of an earlier start are used again.
class StageRunner
{
public:
  StageRunner(StudyState &study, StageStore &store, std::string key)
      : study(study), store(store), key(std::move(key))
  {
  }

  template <typename Stage>
  void run(const std::string &name, const Stage &stage)
  {
    const auto kept = store.load(name);
    const bool usable = kept && kept->value("key", "") == key;
    if (usable)
      study.archive.restore(kept->at("runs"));
    const std::uint64_t before = study.archive.n_requests();
    tables[name] = stage();
    tables[name]["runs"] = study.archive.n_requests() - before;
    store.save(name,
               {{"key", key}, {"table", tables[name]}, {"runs", study.archive.take_unsaved()}});
    study.log.line("  " + name + ": " + std::to_string(study.archive.n_requests() - before) +
                   " runs" + (usable ? ", found from an earlier start" : ""));
  }

  Table tables = Table::object();

private:
  StudyState &study;
  StageStore &store;
  const std::string key;
};

/// Verdict when nothing was detected: whether most effects would have been.
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

Table candidates(const StudyState &study, const Findings &findings)
{
  std::vector<std::size_t> order(study.effects.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    order[k] = k;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return findings.confidence[a] > findings.confidence[b];
  });
  Table rows = Table::array();
  for (const std::size_t k : order) {
    const Factor &effect = study.effects[k];
    Table row = {{"effect", effect.name},
                 {"confidence", findings.confidence[k]},
                 {"mechanism", effect.mechanism},
                 {"unit", effect.unit},
                 {"source", effect.source}};
    if (findings.detected && is_simulated(study, k)) {
      const Fit alone = fit_model(study, {k});
      row["amplitude alone"] = effect.null_value + alone.position(0) * effect.scale;
      row["gain alone"] = fit_model(study, {}).deviance - alone.deviance;
    }
    rows.push_back(row);
  }
  return rows;
}

Table discrepancies_on_fit(const StudyState &study, const Findings &findings)
{
  const auto of = [&](const Fit &fit) {
    const Emulator emulator = study.emulator_of_columns(fit.effects);
    const Eigen::VectorXd model = study.measured(emulator.origin() + emulator.change(fit.position));
    return discrepancy((study.value - model).cwiseQuotient(study.modes.deviations()),
                       study.noise.point_variance +
                           study.replicate_variance * emulator.leverage(fit.position));
  };
  const Discrepancy before = of(fit_model(study, {}));
  Table table = {{"cells", study.data_points.size()},
                 {"gap before", before.value},
                 {"deviation before", before.before_correction}};
  if (!findings.chosen.fit.effects.empty()) {
    const Discrepancy after = of(findings.chosen.fit);
    table["gap after"] = after.value;
    table["deviation after"] = after.before_correction;
    table["shrink"] = before.value > 0. ? Table(1. - after.value / before.value) : Table(nullptr);
  }
  return table;
}

Table content(StudyState &study, const Findings &findings, const Table &stages)
{
  Table result = {{"verdict", name_of(findings.verdict)},
                  {"exit code", exit_code(findings.verdict)},
                  {"p of nothing missing", findings.p_detected},
                  {"p of nothing missing is a bound", findings.p_is_bound},
                  {"confidence off catalogue", findings.off_catalogue}};
  result["candidates"] = candidates(study, findings);
  result["amplitudes"] = describe_amplitudes(study, findings);
  result["p of the fit"] = findings.p_fit;
  Table ties = Table::array();
  if (findings.verdict == Verdict::tie)
    ties = describe_models(study, findings.tie);
  result["tie"] = ties;
  result["nuisances"] = Table::array();
  const Eigen::VectorXd estimates =
      nuisance_estimates(study, findings.chosen.fit.remainder, findings.chosen.fit.leverage);
  for (std::size_t k = 0; k < study.nuisances.size(); ++k) {
    const Factor &nuisance = study.nuisances[k];
    const double shift = estimates(static_cast<Eigen::Index>(k));
    result["nuisances"].push_back(
        {{"nuisance", nuisance.name},
         {"value", nuisance.null_value + shift * nuisance.prior_deviation},
         {"prior deviations", shift}});
  }
  result["gaps"] = {{"fit", discrepancies_on_fit(study, findings)},
                    {"held-out", stages.value("validate", Table::object())}};
  result["envelopes"] = describe_envelopes(study, findings);
  result["runs"] = {{"asked for", study.archive.n_requests()},
                    {"failed", study.archive.n_failed()},
                    {"budget", study.options.budget}};
  result["notes"] = study.notes;
  result["stages"] = stages;
  return result;
}

} // namespace

Discovery discover(const StudyOptions &options, const MeasuredData &data,
                   const std::vector<Factor> &factors, Simulator &simulator, StageStore &store,
                   Log &log)
{
  StudyState study(options, data, factors, simulator, log);
  Findings findings;
  findings.confidence.assign(study.effects.size(), 0.);
  study.archive.set_aside(held_out_runs(data, options, study.nuisances.size()));
  StageRunner course(study, store, study_key(options, data, factors));
  course.run("null", [&] { return stage_null(study); });
  course.run("detect", [&] { return stage_detect(study, findings); });
  course.run("screen", [&] { return stage_screen(study, findings); });
  findings.chosen.fit = fit_model(study, {});
  if (findings.detected) {
    course.run("confirm", [&] { return stage_confirm(study, findings); });
    course.run("fit", [&] { return stage_fit(study, findings); });
    course.run("iterate", [&] { return stage_iterate(study, findings); });
    decide(findings);
  } else {
    decide_without_detection(course.tables["screen"], findings);
  }
  Table separating = Table::array(), remainder = Table::object();
  course.run("validate", [&] { return stage_validate(study, findings); });
  if (findings.withdrawn)
    findings.verdict = Verdict::off_catalogue;
  if (findings.verdict == Verdict::tie)
    course.run("tie", [&]() -> Table {
      separating = separating_measurements(study, findings.tie);
      return {{"measurements", separating}};
    });
  if (findings.verdict == Verdict::off_catalogue)
    remainder = describe_remainder(study, findings);

  Discovery discovery;
  discovery.verdict = findings.verdict;
  discovery.content = content(study, findings, course.tables);
  discovery.content["measurements that would break the tie"] = separating;
  discovery.content["remainder"] = remainder;
  discovery.n_runs = study.archive.n_requests();
  const bool has_model = findings.verdict == Verdict::named || findings.verdict == Verdict::tie;
  if (has_model)
    discovery.model_after =
        study.amplitudes(findings.chosen.fit.effects, findings.chosen.fit.position);
  for (const auto &row : discovery.content["nuisances"])
    discovery.nuisances[row["nuisance"].get<std::string>()] = row["value"].get<double>();
  log.line("Verdict: " + name_of(findings.verdict));
  return discovery;
}

} // namespace eunoe::discovery
