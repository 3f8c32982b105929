#include <eunoe/core/declare.h>
#include <eunoe/core/files.h>
#include <eunoe/core/parameter_input.h>
#include <eunoe/core/quoted_text.h>
#include <eunoe/core/version.h>
#include <eunoe/discovery/catalogue.h>
#include <eunoe/simulation/process.h>

#include <deal.II/base/parameter_handler.h>

#include <algorithm>
#include <filesystem>

namespace eunoe::discovery {

namespace fs = std::filesystem;

namespace {

const std::string effect_section = "effect";

/// `subsection effect` of an effect's file.
struct EffectParameters : public ParameterSection
{
  EffectParameters()
  {
    effect.unit = "1";
    effect.scale = 0.;
  }

  Effect effect;
  std::string sign = "above", experiments = "all";
  std::vector<double> range = {0., 0.};

  void declare(dealii::ParameterHandler &prm) override
  {
    declare::enter(prm, effect_section);
    declare::entry(prm, "mechanism", effect.mechanism,
                   "What happens in the powder or the machine.");
    declare::entry(prm, "family", effect.family,
                   "What it has in common with other effects. An answer that cannot tell these "
                   "apart says how likely one of them is.");
    declare::entry(prm, "parameter", effect.parameter, "What the amplitude is.");
    declare::entry(prm, "unit", effect.unit, "Unit of the amplitude.");
    declare::entry(prm, "null value", effect.null_value,
                   "Amplitude at which the effect is absent.");
    declare::not_negative(prm, "scale", effect.scale,
                          "Distance from the null value that changes results clearly.");
    declare::list(prm, "range", range, {2, 2}, "Smallest and largest amplitude that make sense.");
    declare::choice(prm, "sign", sign, "above|below|both",
                    "Side of the null value that physics allows.");
    declare::entry(prm, "confounders", effect.confounders,
                   "Effects that are likely to look alike.");
    declare::entry(prm, "source", effect.source, "Where the mechanism or its size is described.");
    declare::choice(prm, "experiments", experiments, "all|spreading|heap",
                    "Kind of process that can have the effect.");
    declare::leave(prm);
  }

  void check(const ParameterCheck &check) const override
  {
    for (const auto &[entry, text] :
         {std::pair("mechanism", &effect.mechanism), {"source", &effect.source}})
      check.require(!text->empty(), {effect_section}, entry, "is missing.",
                    "Say it in a few words: reports show it.");
    check.require(range[0] < range[1], {effect_section}, "range", "is empty.",
                  "Give the smallest and the largest amplitude.");
    check.require(range[0] <= effect.null_value && effect.null_value <= range[1], {effect_section},
                  "null value", "is outside of the range.", "Let the range begin or end with it.");
    const bool up = sign != "below" && effect.null_value + effect.scale <= range[1];
    const bool down = sign != "above" && effect.null_value - effect.scale >= range[0];
    check.require(effect.scale > 0. && (up || down), {effect_section}, "scale",
                  "is " + format(effect.scale) +
                      ", which does not fit between null value and range.",
                  "Give a positive distance within the range.");
  }
};

Factor::Sign sign_of(const std::string &word)
{
  return word == "above"   ? Factor::Sign::above
         : word == "below" ? Factor::Sign::below
                           : Factor::Sign::both;
}

/// Name of the process that the word of an effect's file stands for.
std::string process_of(const std::string &word)
{
  return word == "spreading" ? "powder spreading" : word;
}

/// Files of effects in a folder, in the order of their names.
std::vector<std::string> files_of_effects(const std::string &folder)
{
  std::error_code failure;
  std::vector<std::string> files;
  for (const auto &entry : fs::directory_iterator(folder, failure))
    if (entry.path().extension() == ".prm")
      files.push_back(entry.path().string());
  if (failure)
    throw UserError(folder + " cannot be read: " + failure.message() +
                    ". Name a folder of effects in 'effect folders'.");
  std::sort(files.begin(), files.end());
  return files;
}

} // namespace

std::string shipped(const std::string &name)
{
  std::error_code failure;
  const fs::path program = fs::read_symlink("/proc/self/exe", failure);
  const fs::path installed = program.parent_path().parent_path() / "share" / "eunoe" / name;
  return (fs::exists(installed, failure) ? installed : fs::path(source_folder()) / name).string();
}

Effect read_effect(const std::string &text, const std::string &file, Problems &problems,
                   const FileLoader &load)
{
  EffectParameters parameters;
  Effect &effect = parameters.effect;
  effect.file = file;
  std::vector<InputEntry> own;
  for (const InputEntry &entry : parse_input(text, file, problems, load))
    (!entry.path.empty() && entry.path.front() == effect_section ? own : effect.entries)
        .push_back(entry);
  dealii::ParameterHandler prm;
  parameters.declare(prm);
  const std::size_t n_before = problems.all().size();
  set_entries(prm, own, {}, problems);
  const ParameterCheck check(own, file, problems);
  if (problems.all().size() == n_before)
    parameters.check(check);
  check.require(
      std::any_of(effect.entries.begin(), effect.entries.end(),
                  [](const InputEntry &e) { return e.value.find("${") != std::string::npos; }),
      {}, "", "has no entry that depends on the amplitude.",
      "Give the entries that the effect changes, with '${amplitude}' in their values.");

  effect.name = fs::path(file).stem().string();
  effect.lower = parameters.range[0];
  effect.upper = parameters.range[1];
  effect.sign = sign_of(parameters.sign);
  effect.process = process_of(parameters.experiments);
  return effect;
}

std::vector<Effect> read_effects(const std::vector<std::string> &folders, MPI_Comm comm,
                                 Problems &problems)
{
  const FileLoader load = [comm](const std::string &path) { return read_file(path, comm); };
  std::vector<Effect> all;
  for (const std::string &folder : folders)
    for (const std::string &file :
         files_of_effects(folder == "standard" ? shipped("prm/effects") : folder))
    {
      Effect effect = read_effect(load(file), file, problems, load);
      const auto same = std::find_if(all.begin(), all.end(),
                                     [&](const Effect &e) { return e.name == effect.name; });
      if (same != all.end())
        problems.add(file + ":", "has the name of " + same->file + ".", "Rename it.");
      else
        all.push_back(std::move(effect));
    }
  return all;
}

std::vector<Effect> select(const std::vector<Effect> &all, const std::vector<std::string> &wanted,
                           const std::vector<std::string> &excluded, const std::string &where,
                           Problems &problems)
{
  std::vector<std::string> names;
  for (const Effect &effect : all)
    names.push_back(effect.name);
  const auto contains = [](const std::vector<std::string> &list, const std::string &name) {
    return std::find(list.begin(), list.end(), name) != list.end();
  };
  for (const auto *list : {&wanted, &excluded})
    for (const std::string &name : *list)
      if (!contains(names, name) && !(list == &wanted && name == "all")) {
        const std::string near = nearest_name(name, names);
        problems.add(
            where, "names the effect '" + shortened(name) + "', which is not in the catalogue.",
            near.empty() ? "See eunoe-discovery --list-effects." : "Did you mean '" + near + "'?");
      }
  const bool takes_all = contains(wanted, "all");
  std::vector<Effect> chosen;
  for (const Effect &effect : all)
    if ((takes_all || contains(wanted, effect.name)) && !contains(excluded, effect.name))
      chosen.push_back(effect);
  return chosen;
}

} // namespace eunoe::discovery
