#include <eunoe/core/declare.h>
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
  std::string mechanism, family, parameter, unit = "1", source, sign = "above", experiments = "all";
  double null_value = 0., scale = 0.;
  std::vector<double> range = {0., 0.};
  std::vector<std::string> confounders;

  void declare(dealii::ParameterHandler &prm) override
  {
    declare::enter(prm, effect_section);
    declare::entry(prm, "mechanism", mechanism, "What happens in the powder or the machine.");
    declare::entry(prm, "family", family,
                   "What it has in common with other effects. An answer that cannot tell these "
                   "apart says how likely one of them is.");
    declare::entry(prm, "parameter", parameter, "What the amplitude is.");
    declare::entry(prm, "unit", unit, "Unit of the amplitude.");
    declare::entry(prm, "null value", null_value, "Amplitude at which the effect is absent.");
    declare::not_negative(prm, "scale", scale,
                          "Distance from the null value that changes results clearly.");
    declare::list(prm, "range", range, {2, 2}, "Smallest and largest amplitude that make sense.");
    declare::choice(prm, "sign", sign, "above|below|both",
                    "Side of the null value that physics allows.");
    declare::entry(prm, "confounders", confounders, "Effects that are likely to look alike.");
    declare::entry(prm, "source", source, "Where the mechanism or its size is described.");
    declare::choice(prm, "experiments", experiments, "all|spreading|heap",
                    "Kind of process that can have the effect.");
    declare::leave(prm);
  }

  void check(const ParameterCheck &check) const override
  {
    for (const auto &[entry, text] : {std::pair("mechanism", &mechanism), {"source", &source}})
      check.require(!text->empty(), {effect_section}, entry, "is missing.",
                    "Say it in a few words: reports show it.");
    check.require(range[0] < range[1], {effect_section}, "range", "is empty.",
                  "Give the smallest and the largest amplitude.");
    check.require(range[0] <= null_value && null_value <= range[1], {effect_section}, "null value",
                  "is outside of the range.", "Let the range begin or end with it.");
    const bool up = sign != "below" && null_value + scale <= range[1];
    const bool down = sign != "above" && null_value - scale >= range[0];
    check.require(scale > 0. && (up || down), {effect_section}, "scale",
                  "is " + format(scale) + ", which does not fit between null value and range.",
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

} // namespace

Effect read_effect(const std::string &text, const std::string &file, Problems &problems,
                   const FileLoader &load)
{
  Effect effect;
  effect.file = file;
  std::vector<InputEntry> own;
  for (const InputEntry &entry : parse_input(text, file, problems, load))
    (!entry.path.empty() && entry.path.front() == effect_section ? own : effect.patch.entries)
        .push_back(entry);
  EffectParameters parameters;
  dealii::ParameterHandler prm;
  parameters.declare(prm);
  const std::size_t n_before = problems.all().size();
  set_entries(prm, own, {}, problems);
  const ParameterCheck check(own, file, problems);
  if (problems.all().size() == n_before)
    parameters.check(check);
  check.require(
      std::any_of(effect.patch.entries.begin(), effect.patch.entries.end(),
                  [](const InputEntry &e) { return e.value.find("${") != std::string::npos; }),
      {}, "", "has no entry that depends on the amplitude.",
      "Give the entries that the effect changes, with '${amplitude}' in their values.");

  Factor &factor = effect.factor;
  factor.name = fs::path(file).stem().string();
  factor.kind = Factor::Kind::effect;
  factor.null_value = parameters.null_value;
  factor.scale = parameters.scale;
  factor.lower = parameters.range[0];
  factor.upper = parameters.range[1];
  factor.sign = sign_of(parameters.sign);
  factor.mechanism = parameters.mechanism;
  factor.family = parameters.family;
  factor.unit = parameters.unit;
  factor.source = parameters.source;
  factor.confounders = parameters.confounders;
  factor.parameter = parameters.parameter;
  effect.process = process_of(parameters.experiments);
  return effect;
}

std::vector<Effect> read_catalogue(const std::string &folder, Problems &problems,
                                   const FileLoader &load)
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
  std::vector<Effect> effects;
  for (const std::string &file : files)
    effects.push_back(read_effect(load(file), file, problems, load));
  return effects;
}

std::string standard_catalogue()
{
  std::error_code failure;
  const fs::path program = fs::read_symlink("/proc/self/exe", failure);
  const fs::path installed =
      program.parent_path().parent_path() / "share" / "eunoe" / "prm" / "effects";
  return fs::is_directory(installed, failure) ? installed.string()
                                              : source_folder() + std::string("/prm/effects");
}

std::vector<Effect> select(const std::vector<Effect> &all, const std::vector<std::string> &wanted,
                           const std::vector<std::string> &excluded, const std::string &where,
                           Problems &problems)
{
  std::vector<std::string> names;
  for (const Effect &effect : all)
    names.push_back(effect.factor.name);
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
    if ((takes_all || contains(wanted, effect.factor.name)) &&
        !contains(excluded, effect.factor.name))
      chosen.push_back(effect);
  return chosen;
}

} // namespace eunoe::discovery
