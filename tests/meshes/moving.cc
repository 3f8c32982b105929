// Background meshes that move. In a box with a constant velocity, spheres follow the same paths as
// in a box at rest (Galilean invariance), over many lengths of the box and on any number of ranks.
// A ball in the corner of a turning box is carried around by the force of the walls, m w^2 r.
// Powder poured out of a turning vessel leaves through its outlet wherever that is.

#include "meshes.h"

using namespace test;

namespace {

using Table = std::vector<std::vector<double>>;
const std::string box = generated_mesh(
    "subdivided_hyper_rectangle", "4, 4, 4 : -6e-3, -6e-3, -6e-3 : 6e-3, 6e-3, 6e-3 : true", 0);

std::string grid_motion(const std::string &entries)
{
  return "subsection grid motion\n" + entries + "end\n";
}

std::string flying(const Vec3 &drift)
{
  std::vector<Vec3> positions, velocities;
  for (int i = -2; i <= 2; ++i)
    for (int j = -2; j <= 2; ++j)
      for (int k = -2; k <= 2; ++k) {
        positions.push_back({2e-3 * i, 2e-3 * j, 2e-3 * k});
        velocities.push_back(drift + Vec3{0.3 * std::sin(3. * i + j), 0.3 * std::cos(2. * j - k),
                                          0.2 * ((i + k) % 2)});
      }
  return places(positions, velocities);
}

void test_carried()
{
  const double time = 0.01;
  const Vec3 drift = {8., -3., 1.};
  const std::string rest =
      powder(1e-3, 1., 0., "0, 0, 0", "") +
      "subsection model parameters\n subsection load balancing\n"
      "  set load balance method = frequent\n  set frequency = 300\n end\nend\n";
  const auto result_of = [&](const std::string &motion, const Vec3 &v) {
    return [=](MPI_Comm comm) {
      Case test_case(control(5e-6, time) + box + rest + motion + flying(v), comm);
      test_case.run();
      return particle_table(*test_case);
    };
  };
  const Table still = run_alone_and_together<Table>("box at rest", result_of("", {}));
  const Table carried = run_alone_and_together<Table>(
      "carried box", result_of(grid_motion(" set motion type = translational\n"
                                           " set grid translational velocity x = 8\n"
                                           " set grid translational velocity y = -3\n"
                                           " set grid translational velocity z = 1\n"),
                               drift));
  check("all are there", still.size() == 125 && carried.size() == 125);
  double worst = 0., moved = 0.;
  for (std::size_t k = 0; k < still.size(); ++k)
    for (unsigned int d = 0; d < 3; ++d) {
      worst = std::max(worst, std::abs(carried[k][c_x + d] - time * drift[d] - still[k][c_x + d]));
      moved = std::max(moved, std::abs(still[k][c_vx + d]));
    }
  check("they fly", moved > 0.1);
  // Round-off grows from collision to collision.
  check_close("the same paths", worst, 0., 1e-8);
}

/// Grains fall and heap up in a moving box: whatever 'time end' says, and also after a restart,
/// they come to the same places to the last bit. (A grain must have several contacts at a time, or
/// their order makes no difference.)
void test_time_end()
{
  const double end = 0.04;
  const std::string rest =
      box + powder(1e-3, 0.5, 0.3, "0, -9.81, 0") +
      grid_motion(" set motion type = translational\n"
                  " set grid translational velocity x = 2\n"
                  " set grid translational velocity y = -1\n") +
      "subsection lagrangian physical properties\n"
      " subsection particle type 0\n  set number of particles = 500\n end\nend\n"
      "subsection insertion info\n set insertion method = volume\n"
      " set insertion box points coordinates = -5e-3, -5e-3, -5e-3"
      " : 5e-3, 5e-3, 5e-3\n set insertion distance threshold = 1.2\n"
      " set insertion maximum offset = 0.1\n"
      " set initial velocity = 2, -1, 0\nend\n";
  const auto result_at_end = [&](double time_end, const std::string &more, MPI_Comm comm) {
    Table table;
    Case test_case(control(1e-5, time_end) + rest + more, comm);
    test_case.run([&](Simulation &simulation) {
      if (std::abs(simulation.time() - end) < 1e-9)
        table = particle_table(simulation);
    });
    return table;
  };
  const Table whole = run_alone_and_together<Table>(
      "heap in a carried box", [&](MPI_Comm comm) { return result_at_end(end, "", comm); });
  check(
      "they lie on the floor", whole.size() == 500 && [&] {
        double height = 0.;
        for (const auto &row : whole)
          height += (row[c_y] - (-6e-3 - end)) / static_cast<double>(whole.size());
        return height < 4e-3;
      }());
  check("the same bits with a later end", result_at_end(1.2 * end, "", MPI_COMM_WORLD) == whole);
  const std::string every = "subsection restart\n set checkpoint = true\n set frequency = 2000\n";
  result_at_end(0.5 * end, every + "end\n", MPI_COMM_WORLD);
  check("the same bits after a restart with a later end",
        result_at_end(end, every + " set restart = true\nend\n", MPI_COMM_WORLD) == whole);
}

void test_turning()
{
  const double w = 20., diameter = 1e-3, density = 1000.;
  // In the corner of two walls of the box, both 6 mm from the axis z.
  Case test_case(control(1e-5, 1.) + box + powder(diameter, 0.3, 0.5, "0, 0, 0") +
                 grid_motion(" set motion type = rotational\n set grid rotational speed = 20\n"
                             " set grid rotational axis = 2\n") +
                 places({{5.49e-3, 5.49e-3, 0.}}, {{-w * 5.49e-3, w * 5.49e-3, 0.}}));
  test_case.run();
  const Table table = particle_table(*test_case);
  check("the ball is there", table.size() == 1);
  if (table.size() != 1)
    return;
  const Vec3 x = {table[0][c_x], table[0][c_x + 1], table[0][c_x + 2]},
             v = {table[0][c_vx], table[0][c_vx + 1], table[0][c_vx + 2]};
  const double r = std::hypot(x.x, x.y);
  check_relative("it is in the corner", r, std::sqrt(2.) * 5.5e-3, 1e-3);
  // Three turns and 65.9 degrees have gone by since it was at 45 degrees.
  check_close("where it was carried",
              std::remainder(std::atan2(x.y, x.x) - M_PI / 4. - w, 2. * M_PI), 0., 1e-3);
  check_relative("its speed", norm(v), w * r, 1e-3);
  const double mass = density * M_PI / 6. * diameter * diameter * diameter;
  // On the rank that owns the ball.
  const ParticleArrays &particles = test_case->get_system().particles;
  double inwards = particles.n_owned == 1 ? -dot(particles.force[0].vec(), x) / r : 0.;
  MPI_Allreduce(MPI_IN_PLACE, &inwards, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  check_relative("the walls press it inwards", inwards, mass * w * w * r, 1e-2);
}

void test_pouring()
{
  // The wall x = 6 mm is open. It turns downwards within 0.16 s.
  const auto result_of = [&](MPI_Comm comm) {
    Case test_case(
        control(1e-5, 0.4) + box + powder(1e-3, 0.5, 0.1, "0, -9.81, 0") +
            grid_motion(" set motion type = rotational\n"
                        " set grid rotational speed = -10\n"
                        " set grid rotational axis = 2\n") +
            "subsection DEM boundary conditions\n set number of boundary conditions = 1\n"
            " subsection boundary condition 0\n  set type = outlet\n"
            "  set boundary id = 1\n end\nend\n" +
            flying({}),
        comm);
    std::pair<Table, Table> tables; // while the vessel turns, and at the end
    test_case.run([&](Simulation &simulation) {
      if (simulation.step_number() == 8000)
        tables.first = particle_table(simulation);
    });
    tables.second = particle_table(*test_case);
    return tables;
  };
  const auto tables =
      run_alone_and_together<std::pair<Table, Table>>("vessel that pours", result_of);
  check("some are in it while it turns", !tables.first.empty());
  check("all were poured out", tables.second.empty());
}

} // namespace

EUNOE_MPI_TEST()
{
  test_carried();
  test_time_end();
  test_turning();
  test_pouring();
}
