#include <eunoe/core/sha256.h>
#include <eunoe/core/version.h>
#include <eunoe/discovery/results.h>
#include <eunoe/simulation/forecast.h>

#include <boost/algorithm/string.hpp>

#include <algorithm>
#include <filesystem>

namespace eunoe::discovery {

namespace fs = std::filesystem;

std::string differences(const EntryValues &before, const EntryValues &after)
{
  std::string text;
  std::vector<std::string> open;
  const auto indent = [&] { return std::string(2 * open.size(), ' '); };
  const auto close_to = [&](const std::size_t depth) {
    while (open.size() > depth) {
      open.pop_back();
      text += indent() + "end\n";
    }
  };
  for (const auto &[place, value] : after) {
    const auto old = before.find(place);
    if (old != before.end() && old->second == value)
      continue;
    const auto &path = place.first;
    std::size_t same = 0;
    while (same < open.size() && same < path.size() && open[same] == path[same])
      ++same;
    close_to(same);
    while (open.size() < path.size()) {
      text += indent() + "subsection " + path[open.size()] + "\n";
      open.push_back(path[open.size()]);
    }
    text += indent() + "set " + place.second + " = " + value +
            " # before: " + (old == before.end() ? "none" : old->second) + "\n";
  }
  close_to(0);
  return text;
}

void write_models(const StudyInput &study, const Amplitudes &after, const StudyFolder &folder)
{
  for (const Experiment &experiment : study.experiments) {
    std::map<std::string, std::string> inputs;
    for (const auto &[name, amplitudes] : {std::pair("before", Amplitudes()), {"after", after}}) {
      std::vector<std::string> overrides = experiment.overrides(study.factors, amplitudes);
      overrides.push_back("simulation control/output path = output/" + experiment.name() + "_" +
                          name);
      Problems none;
      inputs[name] = experiment.make(overrides, none).as_input_file();
      folder.write("model_" + std::string(name) + "_" + experiment.name() + ".prm", inputs[name]);
    }
    EntryValues before = values_in(inputs["before"]), now = values_in(inputs["after"]);
    now.erase({{"simulation control"}, "output path"});
    const std::string changes = differences(before, now);
    folder.write("model_" + experiment.name() + ".diff",
                 changes.empty() ? "# The model stays as it is.\n"
                                 : "# What is added to the model of experiment '" +
                                       experiment.name() + "'.\n" + changes);
  }
}

void write_answer(const StudyInput &study, const Discovery &discovery,
                  const DemSimulator &simulator, const StudyFolder &folder)
{
  nlohmann::ordered_json answer = discovery.content;
  auto &origin = answer["provenance"];
  origin["version"] = version();
  origin["git_revision"] = git_revision();
  origin["deal_ii_version"] = deal_ii_version();
  origin["engine"] = engine_digest();
  for (const auto &[name, text] : study.identity())
    if (name != "engine")
      origin["sha256"][name] = sha256(text);
  origin["seed"] = study.parameters.options.seed;
  origin["measured_data"] = study.data.header;
  auto &effects = answer["catalogue"];
  for (const Effect &effect : study.factors) {
    const Factor &f = effect.factor;
    effects.push_back({{"name", f.name},
                       {"kind", f.kind == Factor::Kind::effect ? "effect" : "nuisance"},
                       {"mechanism", f.mechanism},
                       {"family", f.family},
                       {"parameter", f.parameter},
                       {"unit", f.unit},
                       {"null_value", f.null_value},
                       {"scale", f.scale},
                       {"range", {f.lower, f.upper}},
                       {"confounders", f.confounders},
                       {"source", f.source}});
  }
  auto &observables = answer["observables"];
  for (const Experiment &experiment : study.experiments)
    for (const ObservableDescription &o : experiment.observables())
      observables.push_back({{"experiment", experiment.name()},
                             {"name", o.name},
                             {"unit", o.unit},
                             {"index", o.index_meaning},
                             {"text", o.text}});
  auto &experiments = answer["experiments"];
  for (const Experiment &experiment : study.experiments)
    experiments.push_back(
        {{"name", experiment.name()}, {"core_seconds", experiment.estimate().core_seconds()}});
  double core_seconds = 0.;
  for (const auto &run : simulator.ledger())
    core_seconds += run.at("core_seconds").get<double>();
  answer["simulations"] = {{"made_now", simulator.n_runs()},
                           {"from_table", simulator.n_cached()},
                           {"core_hours", core_seconds / 3600.}};
  answer["ledger"] = simulator.ledger();
  folder.write("discovery.json", answer.dump(1) + "\n");
  for (const std::string name :
       {"candidates", "envelopes", "decisive", "effects", "models", "learning curve"})
    folder.write_csv(boost::replace_all_copy(name, " ", "_") + ".csv", answer[name]);
}

namespace {

/// As one word of a shell's command.
std::string quoted(const std::string &text)
{
  return "'" + boost::replace_all_copy(text, "'", "'\\''") + "'";
}

} // namespace

std::string page_command(const std::string &folder)
{
  std::error_code failure;
  const fs::path program = fs::read_symlink("/proc/self/exe", failure);
  for (const fs::path &script : {program.parent_path().parent_path() / "share/eunoe/contrib/tools",
                                 fs::path(source_folder()) / "contrib/tools"})
    if (fs::is_regular_file(script, failure)) {
      const bool has_own = fs::exists("/usr/bin/python3", failure);
      return std::string(has_own ? "/usr/bin/python3" : "python3") + " " + quoted(script.string()) +
             " discovery-report " + quoted(folder);
    }
  return "";
}

void print_answer(const Discovery &discovery, const StudyFolder &folder, Log &log)
{
  for (const auto &[name, amplitude] : discovery.model_after)
    log.line("  " + name + ": " + format(amplitude));
  log.line("The answer is in " + folder.file("discovery.json"));
}

std::size_t print_doubts(const StudyInput &study, const Problems &problems, Log &log)
{
  std::size_t n = problems.warnings().size();
  for (const Problem &doubt : problems.warnings())
    log.warning(doubt.text());
  for (const Experiment &experiment : study.experiments) {
    n += experiment.doubts().size();
    for (const Problem &doubt : experiment.doubts())
      log.warning("Experiment '" + experiment.name() + "': " + doubt.text());
  }
  return n;
}

void print_check(const StudyInput &study, const std::size_t n_warnings, Log &log)
{
  const StudyOptions &options = study.parameters.options;
  const double n_effects = static_cast<double>(study.n_effects());
  const auto n_factors = static_cast<double>(study.factors.size());
  double runs = 0., core_hours = 0.;
  std::uint64_t of_base = 0; // without which there is no study
  for (const Experiment &experiment : study.experiments) {
    const auto count_points = [&](const std::vector<MeasuredPoint> &list) {
      return std::count_if(list.begin(), list.end(), [&](const MeasuredPoint &m) {
        return m.point.experiment == experiment.name();
      });
    };
    const auto n_points = count_points(study.data.fit) + count_points(study.data.held_out);
    const double n_nuisances = n_factors - n_effects;
    const bool is_compared = n_points > 0 || (study.data.fit.empty() && !experiment.is_held_out());
    // First runs; the rest of the budget goes where it is expected to tell most.
    constexpr double levels = 4., replicates = 2., models = 4.;
    const double n = experiment.is_held_out()
                         ? options.validate_runs * (2. + n_nuisances + 1.5 * models)
                     : !is_compared ? 0.
                                    : options.null_runs + 2. * options.nuisance_runs * n_nuisances +
                                          levels * replicates * n_effects;
    of_base += is_compared && !experiment.is_held_out() ? options.null_runs : 0;
    const RunEstimate &estimate = experiment.estimate();
    const double hours = n * estimate.core_seconds() / 3600.;
    log.line("  experiment " + experiment.name() + " (" + experiment.process_name() +
             (experiment.is_held_out() ? ", held out" : "") + "): " +
             format_count(static_cast<double>(n_points), "measured cell", "measured cells") +
             "; first about " + format_count(n, "run", "runs") + " of " +
             format_count(estimate.particles, "particle", "particles") + " and " +
             format_count(estimate.steps, "step", "steps") + ", " +
             format_roughly(estimate.core_seconds()) + " core-seconds each");
    runs += n;
    core_hours += hours;
  }
  // What is left of the budget is spent as the first runs were.
  if (options.budget > 0) {
    core_hours *= static_cast<double>(options.budget) / std::max(1., runs);
    runs = static_cast<double>(options.budget);
  }
  std::string names;
  for (const Effect &effect : study.factors)
    names += (names.empty() ? "" : ", ") + effect.factor.name;
  log.line("  factors:    " + format_count(n_effects, "effect", "effects") + " and " +
           format_count(n_factors - n_effects, "nuisance", "nuisances") + ": " + names);
  if (!study.left_out.empty())
    log.line("  left out, as no experiment can have them: " + boost::join(study.left_out, ", "));
  log.line("  runs:       about " + format_whole(runs) +
           (options.budget > 0 ? " at most" : " at first, and no limit"));
  log.line("  core-hours: about " + format_roughly(core_hours));
  const bool is_short = options.budget > 0 && options.budget < of_base;
  if (is_short)
    log.warning("The budget has no room for the " + std::to_string(of_base) +
                " first runs of the base model, unless the table of runs has some. Increase "
                "'budget of runs'.");
  const std::size_t n = n_warnings + (is_short ? 1 : 0);
  log.line(n == 0 ? "The study is in order."
                  : "The study can be made. " + count_of_warnings(n) + ": see above.");
}

} // namespace eunoe::discovery
