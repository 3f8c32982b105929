// One seed changes all random numbers of a run: with every method of insertion, seeds 1 and 2 give
// different sizes and places; the same seed gives the same bits again, on any number of ranks, and
// the same as if it were set in each entry for a seed. A warning names a seed that it overrides.

#include "../spreading/small_case.h"
#include "../tests.h"

using namespace test;

namespace {

using Table = std::vector<std::vector<double>>;
using Overrides = std::vector<std::string>;

const std::string general = "simulation control/seed = ";

/// Thrown to end a run when its first particles have been seen.
struct Seen
{
};

/// Two types whose diameters are drawn from normal distributions, 70 particles in all.
std::string grains(const std::string &insertion)
{
  const auto type = [](const char *number, const char *diameter) {
    return std::string(" subsection particle type ") + number +
           "\n  set size distribution type = normal\n  set average diameter = " + diameter +
           "\n  set standard deviation = 1e-4\n  set number of particles = 35\n end\n";
  };
  return box_input(1e-6, 1e-5,
                   "subsection lagrangian physical properties\n"
                   " set number of particle types = 2\n" +
                       type("0", "1e-3") + type("1", "1.5e-3") +
                       "end\nsubsection insertion info\n"
                       " set inserted number of particles at each time step = 70\n"
                       " set insertion box points coordinates = -8e-3, -8e-3, -8e-3 : 8e-3, 8e-3, "
                       "8e-3\n set insertion maximum offset = 0.2\n" +
                       insertion + "end\n");
}

/// A heap with the powder and the laws of the small spreading case.
std::string small_heap()
{
  std::string text = small_spreading("results", "");
  text.erase(text.find("subsection powder spreading"));
  text.replace(text.find("powder spreading"), 16, "heap");
  return text + "subsection heap\n set tube inner diameter = 0.6e-3\n set disc diameter = 0.6e-3\n"
                " set number of particles = 100\nend\n";
}

Parameters read(const std::string &input, const Overrides &overrides, Problems &problems)
{
  Parameters parameters = Parameters::read(input, "test.prm", overrides, problems);
  if (!problems.empty())
    throw UserError(problems);
  return parameters;
}

/// The first particles of a run.
Table first_particles(const std::string &input, const Overrides &overrides,
                      MPI_Comm comm = MPI_COMM_WORLD)
{
  Log log(comm, true);
  Problems problems;
  Parameters parameters = read(input, overrides, problems);
  Simulation simulation(parameters, comm, log);
  Table table;
  try {
    simulation.run([&table](Simulation &s) {
      table = particle_table(s);
      if (!table.empty())
        throw Seen();
    });
  } catch (const Seen &) {
  }
  return table;
}

/// Share of the particles for which two tables differ in at least one of these columns.
double share_of_others(const Table &a, const Table &b, const std::vector<Column> &columns)
{
  const std::size_t n = std::min(a.size(), b.size());
  double others = 0.;
  for (std::size_t k = 0; k < n; ++k)
    others += std::all_of(columns.begin(), columns.end(),
                          [&](const Column c) { return a[k][c] == b[k][c]; })
                  ? 0.
                  : 1.;
  return others / static_cast<double>(n);
}

/// The entries for seeds of a case, each with this value.
Overrides each_by_itself(const std::string &input, const std::string &value, bool is_process)
{
  Problems problems;
  Overrides list;
  for (const auto &[place, now] : values_in(read(input, {}, problems).as_input_file())) {
    std::string path;
    for (const std::string &name : place.first)
      path += name + "/";
    const bool is_seed = place.second.find("seed") != std::string::npos;
    if (is_seed && path != "simulation control/" && !(is_process && path == "insertion info/"))
      list.push_back(path + place.second + " = " + value);
  }
  return list;
}

void test_turning(const std::string &name, const std::string &input, bool is_process)
{
  const Table one = first_particles(input, {general + "1"});
  const Table two = first_particles(input, {general + "2"});
  check(name + ": particles come", one.size() >= 10 && two.size() >= 10);
  // Where diameters come from classes, some particles draw the same class again.
  check(name + ": other sizes", share_of_others(one, two, {c_radius}) > 0.3);
  check(name + ": other places", share_of_others(one, two, {c_x, c_y, c_z}) > 0.9);
  check(name + ": the same again", first_particles(input, {general + "2"}) == two);
  check(name + ": as each entry by itself",
        first_particles(input, each_by_itself(input, "2", is_process)) == two);
  check(name + ": seeds as without it",
        first_particles(input, {general + "-1"}) == first_particles(input, {}));
  Table alone;
  if (is_first_rank())
    alone = first_particles(input, {general + "2"}, MPI_COMM_SELF);
  alone = of_all_ranks(MPI_COMM_WORLD, alone);
  check(name + ": the same on any ranks", alone == two);
}

/// The warnings that a run would print.
std::string warnings(const std::string &input, const Overrides &overrides)
{
  Problems problems;
  read(input, overrides, problems);
  std::string text;
  for (const Problem &warning : problems.warnings())
    text += warning.text() + "\n";
  return text;
}

void test_rule()
{
  const std::string input = small_spreading("results", "set seed = 7");
  const std::string own = "powder spreading/seed = 2";
  check("a seed that gives way is named",
        warnings(input, {general + "2"}) ==
            "test.prm:49: subsection 'powder spreading' / entry 'seed' is 7 and gives way to the "
            "general seed, 2.\n",
        warnings(input, {general + "2"}));
  check("equal seeds are no matter", warnings(input, {own, general + "2"}).empty());
  check("nor are seeds without a general one", warnings(input, {own}).empty());
  Problems problems;
  const Parameters parameters = read(input, {general + "2"}, problems);
  const std::string used = parameters.as_input_file();
  const auto values = values_in(used);
  check("its values are those of the text", values == parameters.entries() && values.size() > 100);
  check("what was used has the seeds that were used",
        values.at({{"powder spreading"}, "seed"}) == "2" &&
            values.at({{"lagrangian physical properties", "particle type 0"},
                       "distribution prn seed"}) == "2");
  check("and can be run",
        read(used, {}, problems).as_input_file() == used && warnings(used, {}).empty());
}

} // namespace

EUNOE_MPI_TEST()
{
  test_turning("volume", grains(""), false);
  test_turning("packed", grains(" set insertion method = packed\n"), false);
  test_turning("plane",
               grains(" set insertion method = plane\n set insertion plane point = 0, 0, 0\n"
                      " set insertion plane normal vector = 0, 0, 1\n"
                      " set insertion frequency = 1\n"),
               false);
  test_turning("heap", small_heap(), true);
  test_turning("spreading", small_spreading("results", ""), true);
  test_rule();
}
