#include <eunoe/simulation/lethe_notes.h>

#include <algorithm>
#include <cstdlib>

namespace eunoe {

namespace {

using EntryPath = std::vector<std::string>;

/// A default that differs in a way that changes what comes out.
struct Default
{
  EntryPath path;
  std::string entry, there, here;
};

const std::vector<Default> &defaults()
{
  static const EntryPath control = {"simulation control"}, insertion = {"insertion info"};
  static const std::vector<Default> list = {
      {control, "output frequency", "1, a picture every step", "0, none"},
      {insertion, "insertion maximum offset", "1, by which neighbours can overlap", "0"},
      {insertion, "insertion frequency", "0, in older versions 1, an event every step",
       "0, a single event"},
      {insertion, "inserted number of particles at each time step", "0, in older versions 1",
       "0, all at once"}};
  return list;
}

class Reader
{
public:
  explicit Reader(const std::vector<InputEntry> &entries) : entries(entries) {}

  const InputEntry *find(const EntryPath &path, const std::string &name) const
  {
    const InputEntry *last = nullptr;
    for (const InputEntry &entry : entries)
      if (entry.path == path && entry.name == name)
        last = &entry;
    return last;
  }

  bool has(const EntryPath &path, const std::string &name, const std::string &value) const
  {
    return value_of(path, name, "") == value;
  }

  /// Value of an entry, or of its default.
  std::string value_of(const EntryPath &path, const std::string &name,
                       const std::string &by_default) const
  {
    const InputEntry *const entry = find(path, name);
    return entry == nullptr ? by_default : entry->value;
  }

  double number(const EntryPath &path, const std::string &name, const double by_default) const
  {
    const InputEntry *const entry = find(path, name);
    return entry == nullptr ? by_default : std::strtod(entry->value.c_str(), nullptr);
  }

  bool has_rolling_resistance() const
  {
    const std::string method =
        value_of({"model parameters"}, "rolling resistance torque method", "constant");
    return method != "none" && method != "no_resistance";
  }

  /// Whether particles meet a rolling resistance at walls: a pair takes the harmonic mean of its
  /// coefficients, so neither may be 0.
  bool has_rolling_resistance_at_walls() const
  {
    const std::string properties = "lagrangian physical properties";
    if (!has_rolling_resistance() || number({properties}, "rolling friction wall", 0.1) == 0.)
      return false;
    const double n_types = number({properties}, "number of particle types", 1.);
    for (unsigned int type = 0; type < n_types; ++type)
      if (number({properties, "particle type " + std::to_string(type)},
                 "rolling friction particles", 0.1) != 0.)
        return true;
    return false;
  }

  /// Whether rolling friction and rolling viscous damping of a particle type differ.
  bool has_two_coefficients_of_rolling() const
  {
    const std::string properties = "lagrangian physical properties";
    const double n_types = number({properties}, "number of particle types", 1.);
    for (unsigned int type = 0; type < n_types; ++type) {
      const EntryPath path = {properties, "particle type " + std::to_string(type)};
      if (number(path, "rolling friction particles", 0.1) !=
          number(path, "rolling viscous damping particles", 0.1))
        return true;
    }
    return false;
  }

  bool has_turning_walls() const
  {
    const EntryPath grid = {"grid motion"};
    if (has(grid, "motion type", "rotational") && number(grid, "grid rotational speed", 0.) != 0.)
      return true;
    return std::any_of(entries.begin(), entries.end(), [this](const InputEntry &entry) {
      return entry.path.size() == 2 && entry.path[0] == "DEM boundary conditions" &&
             has(entry.path, "type", "rotational") &&
             number(entry.path, "rotational speed", 0.) != 0.;
    });
  }

  /// Whether a boundary turns or slides in place.
  bool has_sliding_boundaries() const
  {
    return std::any_of(entries.begin(), entries.end(), [this](const InputEntry &entry) {
      return entry.path.size() == 2 && entry.path[0] == "DEM boundary conditions" &&
             (has(entry.path, "type", "translational") ||
              (has(entry.path, "type", "rotational") &&
               number(entry.path, "rotational speed", 0.) != 0.));
    });
  }

  bool has_turning_solids() const
  {
    return std::any_of(entries.begin(), entries.end(), [this](const InputEntry &entry) {
      const EntryPath &path = entry.path;
      return path.size() > 2 && path[0] == "solid objects" && path[1] != "solid volumes" &&
             path.back() == "angular velocity" && entry.name == "Function expression" &&
             // Three expressions, of which one is not 0.
             value_of(path, entry.name, "").find_first_not_of("0.;+- \t") != std::string::npos;
    });
  }

  /// Number of entries anywhere with a name and a value.
  std::ptrdiff_t count(const std::string &name, const std::string &value) const
  {
    return std::count_if(entries.begin(), entries.end(), [&](const InputEntry &entry) {
      return entry.name == name && entry.value == value;
    });
  }

private:
  const std::vector<InputEntry> &entries;
};

/// Where contacts follow other laws in Lethe.
void add_notes_on_laws(const Reader &input, std::vector<std::string> &notes)
{
  const EntryPath model = {"model parameters"};
  const std::string law = input.value_of(model, "particle particle contact force method", ""),
                    of_walls =
                        input.value_of(model, "particle wall contact force method", "nonlinear");
  if (law == "DMT")
    notes.emplace_back("Lethe: particles that attract each other across a gap by DMT also feel the "
                       "force and the torque of the last other contact that was computed; here "
                       "they feel their attraction alone.");
  if (of_walls == "nonlinear" && (law == "hertz" || law == "hertz_mindlin_limit_force"))
    notes.push_back("Lethe: walls of the law 'nonlinear' recompute the tangential displacement at "
                    "the Coulomb limit and damp it, as 'hertz_mindlin_limit_overlap' does; here "
                    "they have the law of the particles, '" +
                    law + "'.");
  const bool pairs_have_necks = law == "hertz_JKR" || law == "JKR";
  if (pairs_have_necks || of_walls == "JKR")
    notes.push_back(
        "Lethe: JKR acts while the bodies overlap, and forms no neck; tangential and rolling "
        "stiffness and all damping go by sqrt(R d) instead of the contact radius, and the limit of "
        "rolling lacks twice the pull-off force." +
        std::string(pairs_have_necks
                        ? " Between particles the Coulomb limit does not count the damping, and "
                          "the tangential displacement grows on beyond it."
                        : ""));
  if (law == "linear" && input.has_rolling_resistance() && input.has_two_coefficients_of_rolling())
    notes.emplace_back("Lethe: with 'linear', versions of 2026 exchange rolling friction and "
                       "rolling viscous damping between particles; here each entry is what it is "
                       "called.");
  if (input.has_rolling_resistance_at_walls() &&
      (input.has_turning_walls() || input.has_turning_solids()))
    notes.emplace_back("Lethe: rolling resistance at walls and solids goes by the spin of the "
                       "particle alone; here by its spin relative to theirs, so that a particle "
                       "that turns with them meets none.");
  if (input.has_sliding_boundaries())
    notes.emplace_back("Lethe: a wall that turns or slides in place has its whole velocity there, "
                       "also along the normal of a facet, which damping takes for an approach or a "
                       "retreat; here only the part along the wall counts.");
  if (input.has_turning_solids())
    notes.emplace_back("Lethe: the surface of a solid that turns with w moves with (|x - c| w) x n "
                       "there, where x is the particle's centre, c the centre of rotation and n "
                       "the normal of the contact; here with w x r, where r leads from c to the "
                       "surface. They agree only where n is radial and r perpendicular to w.");
}

} // namespace

std::vector<std::string> notes_for_lethe(const std::vector<InputEntry> &entries)
{
  const Reader input(entries);
  std::vector<std::string> notes;
  if (!input.has({}, "dimension", "3"))
    return notes;
  const InputEntry *const method = input.find({"insertion info"}, "insertion method");
  const bool goes_on = input.has({"restart"}, "restart", "true");
  const bool fills = !goes_on && (method == nullptr || method->value == "volume" ||
                                  method->value == "uniform" || method->value == "non_uniform");
  for (const Default &rule : defaults())
    if (input.find(rule.path, rule.entry) == nullptr &&
        (rule.path.front() != "insertion info" || fills) &&
        !(rule.entry == "insertion maximum offset" &&
          input.find(rule.path, "insertion random number range") != nullptr))
      notes.push_back("Lethe: '" + rule.entry + "' is not set; there its default is " + rule.there +
                      ", here it is " + rule.here + ".");
  const EntryPath model = {"model parameters"};
  if (input.find(model, "integration method") == nullptr ||
      input.has(model, "integration method", "velocity_verlet"))
    notes.emplace_back(
        "Lethe: its velocity Verlet lacked the opening half step until August 2026.");
  const EntryPath balancing = {"model parameters", "load balancing"};
  const InputEntry *const balance = input.find(balancing, "load balance method");
  if (balance != nullptr && balance->value != "none")
    notes.emplace_back("Lethe: contacts of particles lose their history at every load balancing; "
                       "here they keep it.");
  add_notes_on_laws(input, notes);
  if (input.count("custom distribution interpolation", "true") > 0)
    notes.emplace_back("Lethe: interpolated custom distributions given by volume were sampled "
                       "wrongly until July 2026.");
  if (input.count("type", "periodic") > 1)
    notes.emplace_back("Lethe: with two periodic directions, some contacts count twice on several "
                       "ranks.");
  if (input.has({"mesh"}, "expand particle-wall contact search", "true"))
    notes.emplace_back("Lethe: by 'expand particle-wall contact search' a flat wall counts once "
                       "for every boundary cell around a particle, which makes it stiffer and "
                       "dampens more; here it counts once.");
  if (goes_on)
    notes.emplace_back("Lethe: its restart files hold no contact history; here contacts keep it.");
  return notes;
}

} // namespace eunoe
