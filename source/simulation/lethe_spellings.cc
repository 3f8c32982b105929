#include <eunoe/core/quoted_text.h>
#include <eunoe/simulation/lethe_rules.h>
#include <eunoe/simulation/lethe_spellings.h>

#include <algorithm>
#include <functional>
#include <map>

namespace eunoe {

namespace {

using namespace lethe_rules;

/// Whether a path is the one of a rule, in which a name may end in '*'.
bool fits(const EntryPath &path, const EntryPath &rule)
{
  return path.size() == rule.size() &&
         std::equal(path.begin(), path.end(), rule.begin(),
                    [](const std::string &name, const std::string &pattern) {
                      return !pattern.empty() && pattern.back() == '*'
                                 ? name.compare(0, pattern.size() - 1, pattern, 0,
                                                pattern.size() - 1) == 0
                                 : name == pattern;
                    });
}

class Translator
{
public:
  Translator(std::vector<InputEntry> &entries, Problems &problems)
      : entries(entries), problems(problems)
  {
  }

  void run()
  {
    // Of a case in a plane all else would be wrong, too.
    for (const InputEntry &entry : entries)
      if (entry.path.empty() && entry.name == "dimension" && entry.value != "3") {
        takes_out(entry);
        entries.clear();
        return;
      }
    for (InputEntry &entry : entries)
      move(entry);
    number_the_box();
    name_default_surface();
    for (const Components &rule : components())
      join(rule);
    entries.erase(std::remove_if(entries.begin(), entries.end(),
                                 [this](const InputEntry &entry) { return takes_out(entry); }),
                  entries.end());
    for (std::size_t k = 0; k < entries.size(); ++k) {
      // The entry of this name held shares of the volume.
      if (fits(entries[k].path, {"lagrangian physical properties", "particle type *"}) &&
          entries[k].name == "custom volume fractions")
      {
        InputEntry basis = entries[k];
        basis.name = "distribution weighting basis";
        basis.value = "volume";
        entries.insert(entries.begin() + static_cast<std::ptrdiff_t>(k), basis);
        ++k;
      }
      rename(entries[k]);
    }
  }

private:
  static std::string place(const InputEntry &entry)
  {
    return entry.where + ": " + describe(entry.path, entry.name);
  }

  /// Solids stood directly in 'solid objects'; 'adaptive sparse contacts' had another name.
  void move(InputEntry &entry)
  {
    EntryPath &path = entry.path;
    const bool is_solid = path.size() >= 2 && path[0] == "solid objects" &&
                          path[1].compare(0, 13, "solid object ") == 0;
    const bool is_number = path == EntryPath{"solid objects"} && entry.name == "number of solids";
    if (is_solid || is_number) {
      if (is_number)
        problems.warn(place(entry), "stands in the subsection 'solid surfaces' now.", "");
      path.insert(path.begin() + 1, "solid surfaces");
    }
    if (path.size() >= 2 && path[0] == "model parameters" &&
        path[1] == "dynamic disabling contacts") {
      if (entry.name.empty())
        problems.warn(place(entry), "is 'adaptive sparse contacts' now.", "");
      path[1] = "adaptive sparse contacts";
    }
  }

  /// 'box refinement' held one box without a number.
  void number_the_box()
  {
    const EntryPath section = {"box refinement"};
    const auto is_count = [&](const InputEntry &entry) {
      return entry.path == section && entry.name == "initial refinement";
    };
    const auto count = std::find_if(entries.begin(), entries.end(), is_count);
    const bool refines = count != entries.end() && count->value != "0";
    std::vector<InputEntry> numbered;
    for (const InputEntry &entry : entries) {
      const bool is_mesh =
          entry.path.size() > 1 && entry.path[0] == section[0] && entry.path[1] == "mesh";
      if ((is_count(entry) || is_mesh) && !refines)
        continue;
      numbered.push_back(entry);
      if (is_count(entry)) {
        problems.warn(place(entry), "is 'additional refinement' of a subsection 'box 0' now.", "");
        numbered.back().name = "number of refinement boxes";
        numbered.back().value = "1";
        numbered.push_back(entry);
        numbered.back().name = "additional refinement";
      }
      if (is_count(entry) || is_mesh)
        numbered.back().path.insert(numbered.back().path.begin() + 1, "box 0");
    }
    entries = numbered;
  }

  /// A surface of deal.II without a name is a square.
  void name_default_surface()
  {
    const EntryPath surface = {"solid objects", "solid surfaces", "solid object *", "mesh"};
    std::vector<InputEntry> named;
    for (const InputEntry &entry : entries) {
      named.push_back(entry);
      if (!fits(entry.path, surface) || entry.name != "type" || entry.value != "dealii" ||
          std::any_of(entries.begin(), entries.end(), [&](const InputEntry &other) {
            return other.path == entry.path && other.name == "grid type";
          }))
        continue;
      named.push_back(entry);
      named.back().name = "grid type";
      named.back().value = "hyper_cube";
    }
    entries = named;
  }

  /// Makes one entry out of those for its components, at the place of the first.
  void join(const Components &rule)
  {
    std::map<EntryPath, std::vector<std::string>> values;
    for (const InputEntry &entry : entries)
      if (fits(entry.path, rule.path))
        for (std::size_t c = 0; c < rule.from.size(); ++c)
          if (entry.name == rule.from[c]) {
            values.try_emplace(entry.path, rule.from.size(), "0");
            values[entry.path][c] = entry.value;
          }
    if (values.empty())
      return;
    const std::size_t depth = rule.to_path.size();
    std::vector<InputEntry> joined;
    for (const InputEntry &entry : entries) {
      const auto found = values.find(entry.path);
      const bool is_component =
          std::find(rule.from.begin(), rule.from.end(), entry.name) != rule.from.end();
      const bool is_opening = entry.name.empty() && rule.path.size() > depth;
      if (found == values.end() || !(is_component || is_opening)) {
        joined.push_back(entry);
        continue;
      }
      if (found->second.empty() || is_opening)
        continue;
      InputEntry whole = entry;
      whole.path.resize(depth);
      whole.name = rule.to;
      whole.value.clear();
      for (std::size_t c = 0; c < found->second.size(); ++c)
        whole.value += (c == 0 ? "" : c == 3 ? " : " : ", ") + found->second[c];
      found->second.clear();
      problems.warn(place(entry),
                    "and its like are one entry now:", "'" + rule.to + " = " + whole.value + "'.");
      joined.push_back(whole);
    }
    entries = joined;
  }

  bool takes_out(const InputEntry &entry)
  {
    for (const Refused &rule : refused())
      if (fits(entry.path, rule.path) && entry.name == rule.entry) {
        if (entry.value != rule.harmless)
          problems.add(place(entry), "is '" + shortened(entry.value) + "'.", rule.why);
        return true;
      }
    return ignores(entry, ignored()) || ignores(entry, ignored_for_heat()) ||
           names_variables(entry);
  }

  /// deal.II's functions let variables have other names.
  bool names_variables(const InputEntry &entry)
  {
    if (entry.name != "Variable names")
      return false;
    std::string names = entry.value;
    names.erase(std::remove(names.begin(), names.end(), ' '), names.end());
    if (names == "x,y,z,t")
      problems.warn(place(entry), "is as always.", "It is ignored.");
    else
      problems.add(place(entry), "is '" + shortened(entry.value) + "'.",
                   "Expressions are in x, y, z and t: give these names there, and leave this out.");
    return true;
  }

  bool ignores(const InputEntry &entry, const std::vector<Ignored> &rules)
  {
    for (const Ignored &rule : rules) {
      const bool of_section = rule.entries.empty();
      if (!fits(entry.path, rule.path) ||
          (!of_section &&
           std::find(rule.entries.begin(), rule.entries.end(), entry.name) == rule.entries.end()))
        continue;
      if (!of_section || entry.name.empty())
        problems.warn(place(entry), rule.why, "It is ignored.");
      return true;
    }
    return false;
  }

  void rename(InputEntry &entry)
  {
    for (const Renamed &rule : renamed())
      if (fits(entry.path, rule.path) && entry.name == rule.from) {
        problems.warn(place(entry), "is called '" + rule.to + "' now.", "");
        entry.name = rule.to;
      }
    for (const Word &rule : words())
      if (fits(entry.path, rule.path) && entry.name == rule.entry && entry.value == rule.from) {
        problems.warn(place(entry), "is '" + rule.from + "', which is '" + rule.to + "' here.", "");
        entry.value = rule.to;
      }
  }

  std::vector<InputEntry> &entries;
  Problems &problems;
};

} // namespace

void translate_lethe(std::vector<InputEntry> &entries, Problems &problems)
{
  Translator(entries, problems).run();
}

} // namespace eunoe
