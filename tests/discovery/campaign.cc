// A campaign of simulations: the same results on any number of ranks, each run made once, kept in
// a table and found again, also by another version of the program if it gives the same bits; runs
// that fail; seeds; null values.

#include <eunoe/core/sha256.h>
#include <eunoe/core/version.h>
#include <eunoe/discovery/dem_simulator.h>
#include <eunoe/discovery/study_input.h>

#include "../on_one_rank.h"
#include "drop_process.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <regex>

namespace {

using namespace test;
using namespace eunoe::discovery;

const std::string folder = DISCOVERY_TESTS;
const std::string table = "campaign.sqlite", table_alone = "campaign_alone.sqlite",
                  table_changed = "campaign_changed.sqlite", table_later = "campaign_later.sqlite";

/// One row per run; the row of a failed run is empty.
Numbers numbers(const std::vector<RunResult> &results)
{
  Numbers rows;
  for (const RunResult &result : results)
    rows.push_back(result.value_or(std::vector<double>()));
  return rows;
}

void check_runs(const std::string &name, const DemSimulator &simulator, const std::uint64_t made)
{
  check(name, simulator.n_runs() == made,
        std::to_string(simulator.n_runs()) + " runs instead of " + std::to_string(made));
}

/// Two experiments and the effects that all tests here use.
struct Setting
{
  std::vector<Experiment> experiments;
  std::vector<Effect> effects;
  MPI_Comm comm;
};

Setting read_setting(const MPI_Comm comm)
{
  Problems problems;
  ExperimentParameters box, gentle;
  box.name = "box";
  box.case_file = gentle.case_file = folder + "/drop.prm";
  gentle.name = "gentle";
  gentle.overrides = {"drop/largest speed = 0.22"};
  Setting setting = {{Experiment(box, comm, problems), Experiment(gentle, comm, problems)},
                     read_effects({folder + "/effects"}, comm, problems),
                     comm};
  check("in order", problems.empty());
  return setting;
}

const std::vector<RunRequest> requests = {{"box", {}, 1},
                                          {"box", {{"bounce", 0.3}}, 1},
                                          {"box", {{"tilt", 1.}, {"bounce", 0.}}, 1},
                                          {"gentle", {{"bounce", 0.35}}, 1},
                                          {"box", {}, 2},
                                          {"box", {{"bounce", 0.}}, 1},
                                          {"box", {{"growth", 20.}}, 1}};

/// Runs with effects differ from the plain run as they should.
void check_effects(const DemSimulator &simulator, const std::vector<RunResult> &results)
{
  const auto value = [&simulator](const std::string &observable) {
    const auto &points = simulator.data_points("box");
    const auto found = std::find_if(points.begin(), points.end(), [&](const DataPoint &point) {
      return point.observable == observable;
    });
    return [column = found - points.begin()](const std::vector<double> &row) {
      return row[static_cast<std::size_t>(column)];
    };
  };
  const auto speed = value("speed"), drift = value("drift");
  const std::vector<double> &plain = *results[0], &bouncing = *results[1], &tilted = *results[2];
  check("an effect that makes contacts more elastic makes spheres faster",
        speed(bouncing) > 1.2 * speed(plain));
  check("an effect that tilts moves them", drift(tilted) > drift(plain) + 0.5e-3);
}

std::vector<RunResult> run_first(const Setting &setting, Log &log)
{
  DemSimulator simulator(setting.experiments, setting.effects, table, 1, setting.comm, log);
  simulator.find_data_points(1);
  print("cells: " + std::to_string(simulator.data_points("box").size()));
  const std::vector<RunResult> first = simulator.run(requests);
  const std::vector<bool> succeed = {true, true, true, false, true, true, false};
  bool as_expected = true;
  for (std::size_t k = 0; k < first.size(); ++k)
    as_expected = as_expected && first[k].has_value() == succeed[k] &&
                  (!first[k] || first[k]->size() == simulator.data_points("box").size());
  check("those that break off have no result, all others one number a cell", as_expected);
  check_effects(simulator, first);
  same_on_one_rank("results", [&](MPI_Comm ranks) {
    if (ranks == MPI_COMM_WORLD)
      return numbers(first);
    Log own_log(ranks, true);
    DemSimulator alone(setting.experiments, setting.effects, table_alone, 1, ranks, own_log);
    alone.find_data_points(1);
    return numbers(alone.run(requests));
  });
  check("a null value changes no bit", *first[0] == *first[5]);
  check("other seeds, other packings", *first[0] != *first[4]);
  // Two base models, and all requests but the first and those equal to it.
  check_runs("equal runs are made once", simulator, 7);
  simulator.run(requests);
  check_runs("and not again", simulator, 7);
  check("the ledger names them", simulator.ledger().size() == 8);
  for (const auto &run : simulator.ledger())
    if (run.contains("failure"))
      print(run.at("failure").get<std::string>().substr(0, 60));
  return first;
}

/// Only data points that all runs of the base model give can be compared.
void find_rare_points(const Setting &setting, Log &log)
{
  DemSimulator simulator(setting.experiments, setting.effects, table, 1, setting.comm, log);
  simulator.find_data_points(1, {}, 3);
  const std::vector<DataPoint> &points = simulator.data_points("box");
  const DataPoint highest{"box", "height", 4};
  check("what only some runs give is no data point",
        std::find(points.begin(), points.end(), highest) == points.end() &&
            simulator.rare_points().count(highest) == 1 &&
            simulator.rare_points().count(points.front()) == 0);
}

/// A run that reaches its end without a data point that was measured has failed, and is said why.
void lack_a_data_point(const Setting &setting, Log &log)
{
  DemSimulator simulator(setting.experiments, setting.effects, table, 1, setting.comm, log);
  simulator.find_data_points(1);
  simulator.require({{"box", "height", 4}});
  const RunRequest odd = {"box", {}, 5};
  check("a run that lacks what was measured has no result", !simulator.run({odd})[0].has_value());
  check("and the ledger says what it lacks",
        simulator.ledger().back().value("failure", "") ==
            "The run ended without a value of 'height', index 4, which was measured.",
        simulator.ledger().back().dump());
}

/// Another simulator finds all in the table.
void run_from_table(const Setting &setting, const std::vector<RunResult> &first, Log &log)
{
  DemSimulator simulator(setting.experiments, setting.effects, table, 2, setting.comm, log);
  simulator.find_data_points(1);
  check("kept results are the same", simulator.run(requests) == first);
  check_runs("nothing is made again", simulator, 0);
  check("all came from the table", simulator.n_cached() == 8);
  const auto known = simulator.known("box");
  check("a study is told what is known",
        known.size() == 5 && known[0].second == first[0] && simulator.known("gentle").size() == 2,
        std::to_string(known.size()));
  DemSimulator begun(setting.experiments, setting.effects, table, 2, setting.comm, log);
  begun.find_data_points(1);
  const auto again = begun.known("box");
  check("also one that takes the keys of cases from the table",
        again.size() == 5 && again[0].second == first[0] &&
            !RunTable(table, setting.comm).keys().empty(),
        std::to_string(again.size()));
  begun.hide_rows_after(3);
  check("but not what was made after its start",
        begun.known("box").size() + begun.known("gentle").size() == 3);
  simulator.require({{"box", "drift", 0}});
  check("a required cell that is there", simulator.run({requests[0]})[0].has_value());
  check("an effect that the process can have", simulator.concerns("box", {"tilt"}));
}

/// Gives all rows to another engine.
void rename_engine(const RunTable &rows, const std::string &engine)
{
  const std::vector<RunTable::Row> all = rows.rows();
  std::vector<const RunTable::Row *> own;
  for (const RunTable::Row &row : all)
    if (row.engine == engine_digest())
      own.push_back(&row);
  rows.adopt(own, engine);
}

/// Rows of another engine are used if samples of them give the same bits.
void run_after_a_change(const Setting &setting, const std::vector<RunResult> &first, Log &log)
{
  RunTable rows(table, setting.comm);
  rename_engine(rows, "another engine");
  {
    DemSimulator simulator(setting.experiments, setting.effects, table, 1, setting.comm, log);
    simulator.find_data_points(1);
    // Two experiments and two effects; one of them, alone of its experiment, is sample of both.
    check_runs("samples are run again", simulator, 4);
    // Runs that failed may fail no more.
    check("the rest is adopted", simulator.run(requests) == first && simulator.n_runs() == 6);
  }
  rename_engine(rows, "another engine");
  for (RunTable::Row row : rows.rows()) {
    row.engine = "an engine with other results";
    for (Measurement &m : row.record.measurements)
      m.value *= 1. + 1e-15;
    if (is_first_rank() && row.engine != "another engine")
      rows.store(row);
  }
  MPI_Barrier(setting.comm);
  const std::size_t n = rows.rows().size();
  DemSimulator simulator(setting.experiments, setting.effects, table, 1, setting.comm, log);
  simulator.find_data_points(1);
  check("of two engines the one with the same bits is adopted",
        simulator.run(requests) == first && simulator.n_runs() < 8);
  check("rows are never lost", rows.rows().size() >= n);
  const auto known = simulator.known("box");
  check("and a study is told of each run once", known.size() == 5, std::to_string(known.size()));
}

/// Copies the rows of this engine into a new table, each changed.
void copy_rows(const std::string &to, const MPI_Comm comm,
               const std::function<void(RunTable::Row &)> &change)
{
  if (is_first_rank())
    std::filesystem::remove(to);
  MPI_Barrier(comm);
  RunTable copy(to, comm);
  copy.open();
  for (RunTable::Row row : RunTable(table, comm).rows()) {
    if (row.engine != engine_digest())
      continue;
    change(row);
    if (is_first_rank())
      copy.store(row);
  }
  MPI_Barrier(comm);
}

/// Changes the last bits of what a run with one effect has measured.
void change_tilt(RunTable::Row &row)
{
  if (row.request.amplitudes.count("tilt") > 0)
    for (Measurement &m : row.record.measurements)
      m.value *= 1. + 1e-15;
}

/// Where an engine has changed one effect, the runs with that effect are made again.
void run_after_a_change_of_an_effect(const Setting &setting, const std::vector<RunResult> &first,
                                     Log &log)
{
  copy_rows(table_changed, setting.comm, [](RunTable::Row &row) {
    row.engine = "an engine with another tilt";
    change_tilt(row);
  });
  DemSimulator simulator(setting.experiments, setting.effects, table_changed, 1, setting.comm, log);
  simulator.find_data_points(1);
  check("what has changed is not adopted", simulator.run(requests) == first);
  check_runs("and the rest is", simulator, 6);
}

const RunRequest second_packing = {"box", {}, 2}, tilted = {"box", {{"tilt", 1.}}, 3},
                 tilted_again = {"box", {{"tilt", 1.}}, 4};

/// Entries that are new, and other words about entries, do not change what a case is.
void run_by_a_later_program(const MPI_Comm comm, const std::vector<RunResult> &first, Log &log)
{
  const std::string engine = "an earlier engine";
  DropSection::is_later = true;
  const Setting setting = read_setting(comm);
  copy_rows(table_later, comm, [&](RunTable::Row &row) { row.engine = engine; });
  {
    DemSimulator simulator(setting.experiments, setting.effects, table_later, 1, comm, log);
    simulator.find_data_points(1);
    check_runs("a program with more entries runs samples again", simulator, 4);
    simulator.run({tilted_again});
    check("and adopts the rest", simulator.run(requests) == first && simulator.n_runs() == 6);
  }
  copy_rows(table_later, comm, [&](RunTable::Row &row) {
    row.engine = engine;
    change_tilt(row);
  });
  {
    DemSimulator simulator(setting.experiments, setting.effects, table_later, 1, comm, log);
    simulator.find_data_points(1);
    simulator.run({second_packing});
    check_runs("where the samples give the same bits", simulator, 4);
    simulator.run({tilted_again});
    check_runs("and nothing else", simulator, 5);
  }
  DropSection::is_later = false;
}

/// A default that no sample feels, but that has changed by what the other engine has noted.
void run_beside_noted_entries(const Setting &setting, const std::vector<RunResult> &first, Log &log)
{
  const std::string engine = "an engine that notes its entries";
  const Experiment &box = setting.experiments.front();
  const std::string entries = box.all_entries();
  const std::string other = std::regex_replace(
      entries, std::regex("\"log frequency\"\\],\"[^\"]*\""), "\"log frequency\"],\"77\"");
  check("another value of an entry", other != entries && box.differs_from(other) &&
                                         !box.differs_from(entries) && !box.differs_from("[]"));
  for (const auto &[noted, made] : {std::pair(entries, 6u), {other, 8u}}) {
    copy_rows(table_later, setting.comm, [&](RunTable::Row &row) { row.engine = engine; });
    RunTable(table_later, setting.comm).store_keys({{box.recipe_of_entries(engine), noted}});
    DemSimulator simulator(setting.experiments, setting.effects, table_later, 1, setting.comm, log);
    simulator.find_data_points(1);
    check("runs of those entries", simulator.run(requests) == first && simulator.n_runs() == made,
          std::to_string(simulator.n_runs()) + " made");
  }
}

/// A default that has changed does not change the key, but the bits.
void run_with_another_default(const MPI_Comm comm, Log &log)
{
  copy_rows(table_later, comm, [](RunTable::Row &row) { row.engine = "an earlier engine"; });
  DropSection::usual_duration = 0.05003;
  const Setting setting = read_setting(comm);
  DemSimulator simulator(setting.experiments, setting.effects, table_later, 1, comm, log);
  simulator.find_data_points(1);
  simulator.run({second_packing});
  check_runs("with another default nothing is adopted", simulator, 5);
  DropSection::usual_duration = 0.05;
}

/// Earlier versions of the program took the hash of the complete input for the key.
void find_old_keys(const Setting &setting, const std::vector<RunResult> &first, Log &log)
{
  const auto experiment_of = [&](const RunRequest &request) -> const Experiment & {
    return setting.experiments[request.experiment == "gentle" ? 1 : 0];
  };
  const auto case_of = [&](const RunRequest &request) {
    return experiment_of(request).make_case(setting.effects, request, setting.comm);
  };
  const auto old_key_of = [&](const RunRequest &request) {
    return experiment_of(request).old_key(setting.effects, request, setting.comm);
  };
  copy_rows(table_later, setting.comm,
            [&](RunTable::Row &row) { row.key = old_key_of(row.request); });
  for (int start = 0; start < 2; ++start) {
    DemSimulator simulator(setting.experiments, setting.effects, table_later, 1, setting.comm, log);
    simulator.find_data_points(1);
    check("runs of this engine are found by their old keys", simulator.run(requests) == first);
    check_runs("without any sample", simulator, 0);
  }
  for (const RunTable::Row &row : RunTable(table_later, setting.comm).rows())
    if (row.key != case_of(row.request).key)
      check("from then on they have today's", false, text_of(row.request));

  // Of another engine and other words about entries, the files and overrides that it has noted
  // tell what a row is of; this one has noted all but one.
  const std::string engine = "an earlier engine";
  std::map<std::string, std::string> notes;
  copy_rows(table_later, setting.comm, [&](RunTable::Row &row) {
    row.engine = engine;
    row.key = old_key_of(row.request);
    if (text_of(row.request) != text_of(second_packing))
      notes[sha256(engine + experiment_of(row.request).recipe(setting.effects, row.request))] =
          row.key;
  });
  RunTable(table_later, setting.comm).store_keys(notes);
  DropSection::is_later = true;
  const Setting later = read_setting(setting.comm);
  DemSimulator simulator(later.experiments, later.effects, table_later, 1, setting.comm, log);
  simulator.find_data_points(1);
  check_runs("what another program has noted is tried", simulator, 4);
  simulator.run({tilted, tilted_again});
  check_runs("and adopted", simulator, 4);
  simulator.run({second_packing});
  check_runs("and nothing that may be of another case", simulator, 5);
  DropSection::is_later = false;
}

} // namespace

EUNOE_MPI_TEST()
{
  const MPI_Comm comm = MPI_COMM_WORLD;
  Log log(comm, true);
  if (is_first_rank())
    for (const std::string &old : {table, table_alone})
      std::filesystem::remove(old);
  MPI_Barrier(comm);

  const Setting setting = read_setting(comm);
  const std::vector<RunResult> first = run_first(setting, log);
  run_from_table(setting, first, log);
  run_after_a_change(setting, first, log);
  run_after_a_change_of_an_effect(setting, first, log);
  {
    DemSimulator simulator(setting.experiments, setting.effects, table, 1, comm, log);
    simulator.run({tilted, tilted_again});
  }
  run_by_a_later_program(comm, first, log);
  run_beside_noted_entries(setting, first, log);
  run_with_another_default(comm, log);
  find_old_keys(setting, first, log);
  find_rare_points(setting, log);
  lack_a_data_point(setting, log);
}
