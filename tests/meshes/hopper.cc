// A hopper of slanted walls with a narrow mouth, periodic in depth: all particles run out and none
// is lost, with the same bits on any number of ranks. And an outlet in the side of a step:
// particles that cross its plane elsewhere stay in the domain.

#include "meshes.h"

using namespace test;

namespace {

struct Result
{
  std::vector<std::vector<double>> on_the_way, at_the_end; ///< the particles
  std::vector<double> counts; ///< the mass and the number that have left, and the number lost

  bool operator==(const Result &other) const
  {
    return on_the_way == other.on_the_way && at_the_end == other.at_the_end &&
           counts == other.counts;
  }
};

Result run(const std::string &input, MPI_Comm comm)
{
  constexpr unsigned long long step_on_the_way = 6000;
  Case test_case(input, comm);
  Result result;
  test_case.run([&](Simulation &simulation) {
    if (simulation.step_number() == step_on_the_way)
      result.on_the_way = particle_table(simulation);
  });
  result.at_the_end = particle_table(*test_case);
  const Ledger &ledger = test_case->get_ledger();
  const Tally left = ledger.through_outlet[0].global(comm);
  result.counts = {left.mass.value(), static_cast<double>(left.number),
                   static_cast<double>(ledger.lost.global(comm).number)};
  return result;
}

const std::string falling =
    powder(1e-3, 0.4, 0.3, "0, -9.81, 0", "  set number of particles = 150\n");

std::string insertion(const std::string &box)
{
  return "subsection insertion info\n set insertion box points coordinates = " + box +
         "\n set insertion distance threshold = 1.2\n set insertion maximum offset = 0.1\nend\n";
}

void hopper()
{
  // A mouth, a wedge and a bin.
  Profile section;
  section.points = {{{-3e-3, -4e-3}}, {{3e-3, -4e-3}},   {{3e-3, 0.}},     {{-3e-3, 0.}},
                    {{10e-3, 10e-3}}, {{-10e-3, 10e-3}}, {{10e-3, 18e-3}}, {{-10e-3, 18e-3}}};
  section.quads = {{{0, 1, 2, 3}}, {{3, 2, 4, 5}}, {{5, 4, 6, 7}}};
  section.ids = {{{{0, 1}}, 1}};
  section.depth = 8e-3;
  write_mesh(section, "hopper.msh");
  const std::string input =
      control(1e-5, 0.35) + gmsh_mesh("hopper.msh", 1) + falling +
      insertion("-8e-3, 9e-3, 0 : 8e-3, 17e-3, 8e-3") +
      "subsection DEM boundary conditions\n set number of boundary conditions = 2\n"
      " subsection boundary condition 0\n  set type = outlet\n  set boundary id = 1\n end\n"
      " subsection boundary condition 1\n  set type = periodic\n  set periodic id 0 = 8\n"
      "  set periodic id 1 = 9\n  set periodic direction = 2\n end\nend\n";
  const Result result =
      run_alone_and_together<Result>("hopper", [&](MPI_Comm comm) { return run(input, comm); });
  check("hopper: some are on their way", result.on_the_way.size() > 50,
        std::to_string(result.on_the_way.size()));
  check("hopper: all have left", result.at_the_end.empty() && result.counts[1] == 150.);
  check("hopper: nobody is lost", result.counts[2] == 0.);
}

/// A deep pool to the right of a shelf on the left; the wall between them is the outlet.
void pool()
{
  Profile section;
  section.points = {{{-8e-3, 0.}}, {{0., 0.}},     {{8e-3, 0.}},  {{-8e-3, 8e-3}},
                    {{0., 8e-3}},  {{8e-3, 8e-3}}, {{0., -8e-3}}, {{8e-3, -8e-3}}};
  section.quads = {{{0, 1, 4, 3}}, {{1, 2, 5, 4}}, {{6, 7, 2, 1}}};
  section.ids = {{{{1, 6}}, 1}};
  section.depth = 8e-3;
  write_mesh(section, "pool.msh");
  const std::string input =
      control(1e-5, 0.2) + gmsh_mesh("pool.msh", 1) + falling +
      insertion("-8e-3, 1e-3, 0 : 8e-3, 7e-3, 8e-3") +
      "subsection DEM boundary conditions\n set number of boundary conditions = 1\n"
      " subsection boundary condition 0\n  set type = outlet\n  set boundary id = 1\n end\nend\n";
  const Result result =
      run_alone_and_together<Result>("pool", [&](MPI_Comm comm) { return run(input, comm); });
  std::size_t on_shelf = 0, in_pool = 0;
  for (const auto &row : result.at_the_end) {
    on_shelf += row[c_x] < 0. && row[c_y] > 0.4e-3 ? 1 : 0;
    in_pool += row[c_x] > 0. ? 1 : 0;
  }
  check("pool: some lie on the shelf, behind the plane of the outlet", on_shelf > 20);
  check("pool: some have left", result.counts[1] > 5.);
  check("pool: nobody is elsewhere", on_shelf + in_pool == result.at_the_end.size());
  check("pool: numbers add up",
        static_cast<double>(result.at_the_end.size()) + result.counts[1] == 150.);
  check("pool: nobody is lost", result.counts[2] == 0.);
}

} // namespace

EUNOE_MPI_TEST()
{
  hopper();
  pool();
}
