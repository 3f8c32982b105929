// What earlier versions of the program, or other studies, have left in the table of runs: which of
// it is of this study's cases, and is used.

#include <eunoe/core/problems.h>
#include <eunoe/core/sha256.h>
#include <eunoe/core/version.h>
#include <eunoe/discovery/dem_simulator.h>

#include <boost/algorithm/string/join.hpp>

#include <algorithm>
#include <utility>

namespace eunoe::discovery {

namespace {

/// The parts of a study that a run uses: its experiment and the factors that it moves.
std::vector<std::string> parts_of(const RunRequest &request)
{
  std::vector<std::string> parts = {"experiment " + request.experiment};
  for (const auto &[name, amplitude] : request.amplitudes)
    parts.push_back(name);
  return parts;
}

/// Recipes of keys, and of keys of the complete input.
///@{
std::string recipe_of(const std::string &engine, const std::string &made_from)
{
  return sha256("entries that are not defaults\n" + engine + made_from);
}
std::string old_recipe_of(const std::string &engine, const std::string &made_from)
{
  return sha256(engine + made_from);
}
///@}

} // namespace

bool DemSimulator::is_of_study(const RunRequest &request) const
{
  return std::any_of(experiments.begin(), experiments.end(),
                     [&](const Experiment &e) { return e.name() == request.experiment; }) &&
         std::all_of(request.amplitudes.begin(), request.amplitudes.end(), [&](const auto &a) {
           return std::any_of(factors.begin(), factors.end(),
                              [&](const Effect &e) { return e.name == a.first; });
         });
}

void DemSimulator::remember(const StudyCase &one)
{
  // Files that a case names may change without their names.
  if (!one.problem.empty() || one.names_files)
    return;
  const std::string recipe =
      recipe_of(engine_digest(), one.experiment->recipe(factors, one.request));
  if (keys_by_recipe[recipe] != one.key)
    keys_by_recipe[recipe] = new_keys[recipe] = one.key;
}

void DemSimulator::store_new_keys()
{
  if (!new_keys.empty())
    table.store_keys(std::exchange(new_keys, {}));
}

std::string DemSimulator::key_of(const RunTable::Row &row)
{
  const Experiment &experiment = find(row.request.experiment);
  std::string made_from;
  try {
    made_from = experiment.recipe(factors, row.request);
  } catch (const UserError &) {
    const std::string key = case_of(row.request).key;
    return key == row.key ? key : "";
  }
  const auto by_recipe = [&](const std::string &recipe) {
    const auto found = keys_by_recipe.find(recipe);
    return found == keys_by_recipe.end() ? "" : found->second;
  };
  std::string key = by_recipe(recipe_of(engine_digest(), made_from));
  if (key.empty()) {
    const StudyCase one = case_of(row.request);
    remember(one);
    key = one.key;
  }
  if (row.key == key)
    return key;
  // Keys of the complete input change with the program. Then its notes may tell that it made the
  // row from the same files and overrides.
  if (row.key == by_recipe(recipe_of(row.engine, made_from)) ||
      row.key == by_recipe(old_recipe_of(row.engine, made_from)))
    return key;
  const std::string recipe = old_recipe_of(engine_digest(), made_from);
  std::string old_key = by_recipe(recipe);
  if (old_key.empty()) {
    old_key = experiment.old_key(factors, row.request, comm);
    // Noted as `remember` does it: of cases whose files cannot change.
    if (keys_by_recipe.count(recipe_of(engine_digest(), made_from)) > 0)
      keys_by_recipe[recipe] = new_keys[recipe] = old_key;
  }
  return row.key == old_key ? key : "";
}

/// Runs simulations of another engine again, as far as this one has not made them.
/// @return parts of the study in whose simulations a result has changed
std::set<std::string> DemSimulator::find_changes(
    const std::map<std::string, const RunTable::Row *> &samples)
{
  std::vector<StudyCase> cases;
  for (const auto &[part, row] : samples)
    if (records.count(row->key) == 0)
      cases.push_back(case_of(row->request));
  simulate_missing(cases);
  std::set<std::string> changed;
  for (const auto &[part, row] : samples)
    if (text_of(records.at(row->key).measurements) != text_of(row->record.measurements))
      changed.insert(part);
  return changed;
}

/// A sample of each experiment and each factor is run again, with as few other factors as there
/// are. What uses a part with other results is not adopted.
void DemSimulator::adopt(const std::vector<const RunTable::Row *> &rows)
{
  const auto is_known = [this](const RunTable::Row *row) { return records.count(row->key) > 0; };
  const auto n_unknown =
      static_cast<std::ptrdiff_t>(rows.size()) - std::count_if(rows.begin(), rows.end(), is_known);
  if (n_unknown == 0)
    return;
  // What this engine has made is not made again, so that a study that goes on finds the same.
  const auto cost = [&](const RunTable::Row *row) {
    return std::pair(!is_known(row), row->request.amplitudes.size());
  };
  std::map<std::string, const RunTable::Row *> samples;
  for (const RunTable::Row *const row : rows)
    for (const std::string &part : parts_of(row->request))
      if (const auto [sample, is_first] = samples.emplace(part, row);
          !is_first && cost(row) < cost(sample->second))
        sample->second = row;
  std::set<std::string> changed = find_changes(samples);
  // A default that few runs feel may have changed beside the samples.
  for (const Experiment &experiment : experiments) {
    const auto noted = keys_by_recipe.find(experiment.recipe_of_entries(rows.front()->engine));
    if (noted != keys_by_recipe.end() && experiment.differs_from(noted->second))
      changed.insert("experiment " + experiment.name());
  }
  std::vector<const RunTable::Row *> adopted;
  for (const RunTable::Row *const row : rows) {
    const std::vector<std::string> parts = parts_of(row->request);
    if (std::any_of(parts.begin(), parts.end(),
                    [&](const std::string &part) { return changed.count(part) > 0; }))
      continue;
    adopted.push_back(row);
    records.emplace(row->key, row->record);
  }
  table.adopt(adopted, engine_digest());
  log.line("Of " + std::to_string(n_unknown) +
           " runs of an earlier version of the engine, those are used of whose experiments and "
           "factors a sample, run again, gave the same bits" +
           (changed.empty() ? ": all." : "; not those with: " + boost::join(changed, ", ") + "."));
}

void DemSimulator::adopt_earlier_runs()
{
  for (const Experiment &experiment : experiments) {
    const std::string recipe = experiment.recipe_of_entries(engine_digest());
    if (keys_by_recipe.count(recipe) == 0)
      keys_by_recipe[recipe] = new_keys[recipe] = experiment.all_entries();
  }
  std::vector<const RunTable::Row *> renamed;
  std::map<std::string, std::vector<const RunTable::Row *>> others;
  for (RunTable::Row &row : earlier) {
    if (row.key.empty())
      continue;
    // The case may have changed since, or belong to another study.
    const std::string key = is_of_study(row.request) ? key_of(row) : "";
    const bool is_renamed = std::exchange(row.key, key) != key;
    if (key.empty())
      continue;
    if (row.engine != engine_digest()) {
      // A failure may have been the engine's.
      if (row.record.failure.empty())
        others[row.engine].push_back(&row);
    } else if (is_renamed && records.emplace(key, row.record).second)
      renamed.push_back(&row);
  }
  store_new_keys();
  if (!renamed.empty()) {
    table.adopt(renamed, engine_digest());
    log.line(std::to_string(renamed.size()) +
             " runs of this version of the engine have keys of an earlier version of the program, "
             "and are used.");
  }
  for (const auto &[engine, rows] : others)
    adopt(rows);
}

} // namespace eunoe::discovery
