#include <eunoe/core/quoted_text.h>
#include <eunoe/simulation/lethe_spellings.h>

#include <algorithm>
#include <functional>
#include <map>

namespace eunoe {

namespace {

using EntryPath = std::vector<std::string>;

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

const EntryPath properties = {"lagrangian physical properties"},
                type = {"lagrangian physical properties", "particle type *"},
                insertion = {"insertion info"}, model = {"model parameters"},
                control = {"simulation control"},
                boundary = {"DEM boundary conditions", "boundary condition *"}, mesh = {"mesh"},
                no_section = {};

/// An entry with another name.
struct Renamed
{
  EntryPath path;
  std::string from, to;
};
const std::vector<Renamed> &renamed()
{
  static const std::vector<Renamed> list = {
      {type, "random seed distribution", "distribution prn seed"},
      {type, "custom volume fractions", "custom distribution diameters probabilities"},
      {insertion, "insertion file name", "list of input files"},
      {insertion, "clearing particles", "remove particles"},
      {insertion, "clearing box points coordinates", "removal box points coordinates"},
      {insertion, "insertion random number range", "insertion maximum offset"},
      {insertion, "insertion random number seed", "insertion prn seed"},
      {{"post-processing"}, "Lagrangian post-processing", "lagrangian post-processing"},
      {{"model parameters", "adaptive sparse contacts"},
       "enable dynamic disabling contacts",
       "enable adaptive sparse contacts"}};
  return list;
}

/// A word with another spelling; without a new one the entry is not needed.
struct Word
{
  EntryPath path;
  std::string entry, from, to;
};
const std::vector<Word> &words()
{
  static const std::vector<Word> list = {
      {model, "rolling resistance torque method", "no_resistance", "none"},
      {model, "rolling resistance torque method", "constant_resistance", "constant"},
      {model, "rolling resistance torque method", "viscous_resistance", "viscous"},
      {model, "rolling resistance torque method", "epsd_resistance", "epsd"},
      {control, "output frequency", "-1", "0"},
      {control, "log frequency", "-1", "0"},
      {insertion, "insertion method", "uniform", "volume"},
      {insertion, "insertion method", "non_uniform", "volume"},
      {mesh, "type", "cylinder", "lethe"},
      {mesh, "grid type", "classic", "cylinder_classic"},
      {mesh, "grid type", "balanced", "cylinder_balanced"},
      {mesh, "grid type", "squared", "cylinder_squared"},
      {mesh, "grid type", "regularized", "cylinder_regularized"},
      {{"model parameters", "load balancing"},
       "load balance method",
       "dynamic_with_sparse_contacts",
       "dynamic"}};
  return list;
}

/// Numbers that have become components of one entry.
struct Components
{
  EntryPath path;
  EntryPath from; ///< three numbers, or six for two corners
  EntryPath to_path;
  std::string to;
};
const std::vector<Components> &components()
{
  static const std::vector<Components> list = {
      {properties, {"gx", "gy", "gz"}, properties, "g"},
      {insertion, {"velocity x", "velocity y", "velocity z"}, insertion, "initial velocity"},
      {insertion, {"omega x", "omega y", "omega z"}, insertion, "initial angular velocity"},
      {insertion,
       {"insertion box minimum x", "insertion box minimum y", "insertion box minimum z",
        "insertion box maximum x", "insertion box maximum y", "insertion box maximum z"},
       insertion,
       "insertion box points coordinates"},
      {boundary,
       {"rotational vector x", "rotational vector y", "rotational vector z"},
       boundary,
       "rotational vector"},
      {{"floating walls", "wall *", "point on wall"},
       {"x", "y", "z"},
       {"floating walls", "wall *"},
       "point on wall"},
      {{"floating walls", "wall *", "normal vector"},
       {"nx", "ny", "nz"},
       {"floating walls", "wall *"},
       "normal vector"}};
  return list;
}

/// Entries that change nothing here.
struct Ignored
{
  EntryPath path, entries; ///< no entries: all of the subsection
  std::string why;
};

const std::vector<Ignored> &ignored_for_heat()
{
  static const std::string why = "is for heat between particles.";
  static const std::vector<Ignored> list = {
      {insertion, {"list temperatures"}, why},
      {{"insertion info", "initial temperature function"}, {}, why},
      {type,
       {"thermal conductivity particles", "specific heat particles", "microhardness particles",
        "surface slope particles", "surface roughness particles", "thermal accommodation particles",
        "real young modulus particles"},
       why},
      {properties,
       {"thermal conductivity wall", "microhardness wall", "surface slope wall",
        "surface roughness wall", "thermal accommodation wall", "real young modulus wall",
        "thermal conductivity gas", "specific heat gas", "specific heats ratio gas",
        "molecular mean free path gas"},
       why},
      {{"solid objects", "solid surfaces", "solid object *"}, {"thermal boundary type"}, why},
      {{"solid objects", "solid surfaces", "solid object *", "temperature"}, {}, why}};
  return list;
}

const std::vector<Ignored> &ignored()
{
  static const std::string of_fluids = "is for flows of fluids.";
  static const std::string of_tables = "is not needed: what is recorded is in tables.";
  static const std::vector<Ignored> list = {
      {no_section, {"print parameters"}, "is not needed: used.prm holds all parameters."},
      {no_section, {"comment message"}, "is a remark."},
      {control,
       {"method", "bdf startup method", "startup time scaling", "adapt", "number mesh adapt",
        "max cfl", "max time step", "stop tolerance", "adaptative time step scaling",
        "respect capillary time-step constraint", "capillary time-step ratio", "subdivision",
        "output qcriterion", "output vorticity", "output velocity gradient"},
       of_fluids},
      {control, {"output boundaries"}, "is not needed: cell averages draw the mesh."},
      {control, {"log precision"}, "is not needed."},
      {control, {"group files"}, "is not needed: every picture is one file a rank."},
      {{"timer"}, {}, "is not needed: summary.json has the times of all parts of the program."},
      {{"boundary forces"}, {"verbosity"}, of_tables},
      {{"post-processing", "solid forces"}, {"verbosity"}, of_tables},
      {{"post-processing", "particle wall collision statistics"}, {"verbosity"}, of_tables},
      {{"test"}, {}, "is not needed: --dump writes the complete state at the end."},
      {{"box refinement", "box *", "mesh"},
       {"simplex", "check diamond cells", "expand particle-wall contact search"},
       "is not needed."},
      {{"floating grid"},
       {},
       "has no effect, in Lethe either: a grid that moves is a solid, in 'solid objects'."},
      {{"floating grid", "*"}, {}, "has no effect."},
      {mesh,
       {"check diamond cells", "expand particle-wall contact search"},
       "is not needed: walls are found from every cell."},
      {mesh,
       {"initial boundary refinement", "boundaries refined"},
       "has no effect on particles, in Lethe either: see 'box refinement'."},
      {{"model parameters", "adaptive sparse contacts"}, {"enable particle advection"}, of_fluids},
      {{"model parameters", "adaptive sparse contacts"},
       {"granular temperature threshold", "solid fraction threshold"},
       "is for cells, whose mean motion hides that of a grain: here each particle has its 'rest "
       "speed'."},
      {insertion,
       {"insertion plane threshold distance"},
       "is not needed: a cell takes a particle if it is empty."},
      {properties,
       {"dynamic viscosity gas"},
       "is for heat between particles, not for drag, which has its own in 'model parameters / "
       "drag'."},
      {{"solid objects", "solid volumes"}, {}, "has no effect, as in Lethe."},
      {{"solid objects", "solid volumes", "*"}, {}, "has no effect."},
      {{"solid objects", "solid volumes", "*", "*"}, {}, "has no effect."}};
  return list;
}

/// Entries that are out of scope or have moved, unless their value is harmless.
struct Refused
{
  EntryPath path;
  std::string entry, harmless, why;
};
const std::vector<Refused> &refused()
{
  static const std::string heat = "Heat between particles is out of scope.";
  static const std::vector<Refused> list = {
      {no_section, "dimension", "3", "Simulations are in three dimensions: give 3."},
      {properties, "density gas", "0", "It is 'density' in 'model parameters / drag' now."},
      {model, "solver type", "dem", heat + " Give dem."},
      {model, "disable position integration", "false", heat + " Give false."},
      {mesh, "simplex", "false", "Background meshes are made of hexahedra: give false."}};
  return list;
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
      if (fits(entries[k].path, type) && entries[k].name == "custom volume fractions") {
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
    return ignores(entry, ignored()) || ignores(entry, ignored_for_heat());
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
