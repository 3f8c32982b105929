#include <eunoe/core/files.h>
#include <eunoe/core/first_rank.h>
#include <eunoe/core/problems.h>
#include <eunoe/core/sha256.h>
#include <eunoe/core/version.h>
#include <eunoe/discovery/results.h>
#include <eunoe/simulation/command_line.h>

#include <boost/algorithm/string.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

namespace eunoe::discovery {

namespace fs = std::filesystem;

namespace {

const std::string identity_file = "study.json";

/// The text of a file on the first rank, given to all; nothing if there is none.
std::optional<nlohmann::ordered_json> read_json(const std::string &file, MPI_Comm comm)
{
  std::error_code failure;
  const std::string is_there =
      broadcast(is_first_rank(comm) && fs::exists(file, failure) ? "yes" : "", comm);
  if (is_there.empty())
    return std::nullopt;
  try {
    return nlohmann::ordered_json::parse(read_file(file, comm));
  } catch (const nlohmann::json::exception &) {
    throw UserError(file + " is damaged. Remove it; the runs are kept in their table.");
  }
}

/// A list of objects as a table with commas; members other than numbers, words and truth values
/// are left out. Empty for any other value.
std::string as_csv(const nlohmann::ordered_json &list)
{
  if (!list.is_array() || list.empty() ||
      !std::all_of(list.begin(), list.end(), [](const auto &row) { return row.is_object(); }))
    return "";
  std::vector<std::string> columns;
  for (const auto &row : list)
    for (const auto &[name, value] : row.items())
      if (value.is_primitive() && std::find(columns.begin(), columns.end(), name) == columns.end())
        columns.push_back(name);
  if (columns.empty())
    return "";
  std::string text = boost::join(columns, ",") + "\n";
  for (const auto &row : list) {
    std::vector<std::string> words;
    for (const std::string &column : columns) {
      const auto value = row.find(column);
      words.push_back(value == row.end() || !value->is_primitive() || value->is_null() ? ""
                      : value->is_string() ? value->template get<std::string>()
                                           : value->dump());
      if (words.back().find_first_of(",\"") != std::string::npos)
        words.back() = "\"" + boost::replace_all_copy(words.back(), "\"", "\"\"") + "\"";
    }
    text += boost::join(words, ",") + "\n";
  }
  return text;
}

/// Entries whose values differ, as an input file of the new ones with the old ones beside them.
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

/// As one word of a shell's command.
std::string quoted(const std::string &text)
{
  return "'" + boost::replace_all_copy(text, "'", "'\\''") + "'";
}

} // namespace

std::string StudyFolder::file(const std::string &name) const
{
  return (fs::path(path) / name).lexically_normal().string();
}

std::optional<std::int64_t> StudyFolder::open(const std::map<std::string, std::string> &identity,
                                              const std::int64_t last_row)
{
  const std::string began = "last row of the table at the start";
  create_folder(path, comm);
  try {
    lock = std::make_unique<RunLock>(file("running.lock"), "The folder " + path,
                                     "Wait until it ends, or choose another 'output path'.", comm);
  } catch (const UserError &error) {
    throw RefusedInput(error);
  }
  nlohmann::ordered_json mine;
  for (const auto &[name, text] : identity)
    mine[name] = sha256(text);
  const auto before = read_json(file(identity_file), comm);
  if (!before) {
    mine[began] = last_row;
    write(identity_file, mine.dump(1) + "\n");
    return std::nullopt;
  }
  std::vector<std::string> differ;
  for (const auto &[name, digest] : mine.items())
    if (!before->contains(name) || before->at(name) != digest)
      differ.push_back(name);
  for (const auto &[name, digest] : before->items())
    if (!mine.contains(name) && name != began)
      differ.push_back(name);
  if (!differ.empty())
    throw RefusedInput(UserError(
        "The folder " + path + " holds another study; what differs: " + boost::join(differ, ", ") +
        ". Choose another 'output path', or remove the folder. (With the same 'table of runs' no "
        "run is made twice.)"));
  return before->value(began, std::int64_t(0));
}

void StudyFolder::write_csv(const std::string &name, const nlohmann::ordered_json &list) const
{
  const std::string csv = as_csv(list);
  if (!csv.empty())
    write(name, csv);
  else if (is_first_rank(comm))
    remove_file(file(name)); // that of an earlier answer
}

void StudyFolder::write(const std::string &name, const std::string &text) const
{
  on_first_rank(comm, [&] { write_file(file(name), text); });
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
  for (const Factor &f : study.factors)
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

void write_page(const std::string &folder, MPI_Comm comm, Log &log)
{
  if (!is_first_rank(comm))
    return;
  std::error_code failure;
  const std::string script = shipped("contrib/tools"), python = "/usr/bin/python3";
  const std::string command = (fs::exists(python, failure) ? python : "python3") + " " +
                              quoted(script) + " discovery-report " + quoted(folder);
  if (!fs::is_regular_file(script, failure) || std::system(command.c_str()) != 0)
    log.warning("discovery.html was not written. Run contrib/tools discovery-report " + folder +
                " where Python has Matplotlib.");
}

} // namespace eunoe::discovery
