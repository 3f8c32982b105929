// Forces on the walls of the mesh: the walls bear the weight of a packing at rest, most of it the
// floor, and their horizontal forces balance; a sphere at rest beside the centre exerts the torque
// of its weight. The tables are the same on any number of ranks. Reference: statics.

#include <eunoe/core/files.h>
#include <eunoe/core/table.h>

#include "../on_one_rank.h"

using namespace test;

namespace {

std::string floor_case(const std::string &type, const std::string &insertion, double time_end,
                       const std::string &more)
{
  char head[256];
  std::snprintf(head, sizeof head,
                "subsection simulation control\n set time step = 1e-5\n set time end = %g\n"
                " set log frequency = 0\n set output path = results\nend\n",
                time_end);
  return head +
         std::string("subsection mesh\n set grid type = subdivided_hyper_rectangle\n"
                     " set grid arguments = 3, 3, 4 : 0, 0, 0 : 6e-3, 6e-3, 8e-3 : true\n"
                     "end\nsubsection lagrangian physical properties\n"
                     " set g = 0, 0, -9.81\n set friction coefficient wall = 0.3\n"
                     " subsection particle type 0\n") +
         type +
         "  set young modulus particles = 1e6\n  set friction coefficient particles = 0.3\n"
         "  set restitution coefficient particles = 0.1\n"
         " end\nend\nsubsection model parameters\n set rolling resistance torque method = none\n"
         "end\nsubsection insertion info\n" +
         insertion + "end\nsubsection boundary forces\n set calculation = true\n" + more + "end\n";
}

Table table_of(const std::string &name, MPI_Comm comm = MPI_COMM_WORLD)
{
  return parse_table(read_file("results/" + name, comm), name);
}

/// Largest component of the sum of the forces on all particles and walls, less the weight, over the
/// weight. Contact forces cancel in this sum, so it must vanish.
double imbalance(Simulation &simulation)
{
  const ParticleArrays &p = simulation.complete_step();
  ExactSum weight;
  std::array<ExactSum, 3> sums;
  for (std::size_t k = 0; k < p.n_owned; ++k) {
    weight += 9.81 * p.mass(k);
    for (unsigned int d = 0; d < 3; ++d)
      sums[d] += p.force[k].vec()[d];
  }
  weight.reduce(simulation.communicator());
  double largest = 0.;
  const std::vector<SolidLoad> loads = simulation.global_solid_loads();
  for (unsigned int d = 0; d < 3; ++d) {
    sums[d].reduce(simulation.communicator());
    double total = sums[d].value() + (d == 2 ? weight.value() : 0.);
    for (const SolidLoad &load : loads)
      total += load.force[d].value();
    largest = std::max(largest, std::abs(total));
  }
  return largest / weight.value();
}

/// 60 grains that fall into a box.
std::string packing_case(const std::string &tables, const double time_end)
{
  return floor_case(
      "  set size distribution type = normal\n  set average diameter = 1e-3\n"
      "  set standard deviation = 1e-4\n  set number of particles = 60\n",
      " set insertion box points coordinates = 0, 0, 0 : 6e-3, 6e-3, 8e-3\n"
      " set insertion distance threshold = 1.1\n set insertion maximum offset = 0.1\n",
      time_end, " set filename = " + tables + "\n set output frequency = 2000\n");
}

/// Sums over the particles at a wall are exact, so the tables do not depend on the number of ranks.
void test_ranks()
{
  same_on_one_rank("forces while it falls", [](MPI_Comm comm) {
    Case packing(packing_case("ranks", 0.08), comm);
    packing.run();
    Numbers all;
    for (const char *const id : {"0", "1", "2", "3", "4", "5"})
      for (const auto &row : table_of(std::string("ranks_") + id + ".csv", comm).rows)
        all.push_back(row);
    return all;
  });
}

void test_packing()
{
  Case packing(packing_case("packing", 0.8));
  double worst = 0.;
  packing.run([&worst](Simulation &simulation) {
    if (simulation.step_number() % 2000 == 0 && simulation.step_number() > 0)
      worst = std::max(worst, imbalance(simulation));
  });
  check_close("walls bear what the particles do not accelerate", worst, 0., 1e-13);
  double weight = 0., time = 0.;
  for (const auto &particle : particle_table(*packing))
    weight += sphere_mass(particle[c_radius], 1000.) * 9.81;
  Vec3 sum;
  for (const char *const id : {"0", "1", "2", "3", "4", "5"}) {
    const Table table = table_of(std::string("packing_") + id + ".csv");
    check(std::string("rows of boundary ") + id, table.rows.size() == 41);
    const auto &row = table.rows.back();
    time = row[0];
    sum += Vec3{row[1], row[2], row[3]};
  }
  const auto bottom = table_of("packing_4.csv").rows.back();
  check_close("time of the last row", time, 0.8, 1e-12);
  check_close("weight on all walls", sum.z / weight, -1., 1e-6);
  check_close("the side walls balance", std::hypot(sum.x, sum.y) / weight, 0., 1e-6);
  check("the floor bears most of it", -bottom[3] > 0.9 * weight && -bottom[3] <= 1.05 * weight);
}

void test_torque()
{
  Case sphere(floor_case("  set diameter = 1e-3\n",
                         " set insertion method = list\n set list x = 2e-3\n set list y = 4.5e-3\n"
                         " set list z = 0.5e-3\n set list diameters = 1e-3\n",
                         0.1,
                         " set filename = torque\n set output frequency = 500\n"
                         " subsection center of mass coordinate\n  set x = 3e-3\n  set y = 3e-3\n"
                         "  set z = 4e-3\n end\n"));
  sphere.run();
  const double weight = sphere_mass(0.5e-3, 1000.) * 9.81;
  const Table table = table_of("torque_4.csv");
  const auto &row = table.rows.back();
  check_relative("force of a sphere", -row[3], weight, 1e-9);
  // r = (-1, 1.5, -4) mm, F = (0, 0, -weight): r x F = (-1.5 w, -1 w, 0).
  check_close("its torque about x", row[4] / weight, -1.5e-3, 1e-9);
  check_close("its torque about y", row[5] / weight, -1e-3, 1e-9);
  check_close("its torque about z", row[6] / weight, 0., 1e-9);
  check("nothing on the walls", table_of("torque_0.csv").rows.back()[1] == 0.);
}

/// What is inserted in contact with the floor loads it before the first step: Hertz's force.
void test_first_row()
{
  const double overlap = 1e-6, radius = 0.5e-3, young = 1e6, poisson = 0.3;
  Case sphere(floor_case("  set diameter = 1e-3\n",
                         " set insertion method = list\n set list x = 2e-3\n set list y = 4.5e-3\n"
                         " set list z = 0.499e-3\n set list diameters = 1e-3\n",
                         1e-4, " set filename = first\n set output frequency = 10\n"));
  sphere.run();
  const Table table = table_of("first_4.csv");
  const auto &row = table.rows.front();
  check("the first row is of the start", row[0] == 0.);
  check_relative("force before the first step", -row[3],
                 4. / 3. * young / (2. * (1. - poisson * poisson)) * std::sqrt(radius) *
                     std::pow(overlap, 1.5),
                 1e-9);
}

/// A boundary with several sides has one table: the sum over all of them.
void test_sides_of_one_id()
{
  std::string input = floor_case("  set diameter = 1e-3\n",
                                 " set insertion method = list\n set list x = 2e-3\n"
                                 " set list y = 4.5e-3\n set list z = 0.5e-3\n",
                                 0.1, " set filename = sides\n set output frequency = 500\n");
  input.replace(input.find(" : true"), 7, " : false");
  Case sphere(input);
  sphere.run();
  check_relative("one id for all sides", -table_of("sides_0.csv").rows.back()[3],
                 sphere_mass(0.5e-3, 1000.) * 9.81, 1e-9);
}

} // namespace

EUNOE_MPI_TEST()
{
  test_packing();
  test_ranks();
  test_torque();
  test_first_row();
  test_sides_of_one_id();
}
