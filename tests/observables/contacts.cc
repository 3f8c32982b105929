// The forces in single contacts, as pictures show them: Hertz's force of a known overlap, also
// across a periodic face; those of a packing, with particles and walls, add up to the forces on its
// particles. Evaluating them does not change the run.
// Reference: Hertz; Newton's third law.

#include "../on_one_rank.h"

using namespace test;

namespace {

const char *const elastic =
    " set young modulus wall = 1e6\n set restitution coefficient wall = 1\n"
    " subsection particle type 0\n  set diameter = 1e-3\n  set young modulus particles = 1e6\n"
    "  set restitution coefficient particles = 1\n end\n";

double hertz(double radius, double overlap)
{
  const double young = 1e6 / (2. * (1. - 0.3 * 0.3));
  return 4. / 3. * young * std::sqrt(radius) * std::pow(overlap, 1.5);
}

/// The contacts of all ranks whose first particle is owned: its id, the second one's id or -1,
/// solid, overlap, force, end of the line (m).
std::vector<std::vector<double>> all_contacts(Simulation &simulation)
{
  const ParticleArrays &p = simulation.complete_step();
  std::vector<std::vector<double>> mine;
  for (const ContactForce &c : simulation.contact_forces())
    if (static_cast<std::size_t>(c.first) < p.n_owned) {
      const Vec3 end = p.position[c.first].vec() + c.distance * c.normal;
      mine.push_back({double(p.id[c.first]), c.second < 0 ? -1. : double(p.id[c.second]),
                      double(c.solid), c.overlap, c.normal_force, end.x, end.y, end.z});
    }
  std::vector<std::vector<double>> all = of_all_ranks(simulation.communicator(), mine);
  std::sort(all.begin(), all.end());
  return all;
}

void test_placed_spheres()
{
  // Two overlap across the periodic faces at x = -1 and 1 cm; the third and the floor overlap by
  // 20 um.
  Case placed(box_input(1e-7, 1e-7,
                        std::string("subsection lagrangian physical properties\n") + elastic +
                            "end\nsubsection DEM boundary conditions\n"
                            " set number of boundary conditions = 1\n"
                            " subsection boundary condition 0\n  set type = periodic\n"
                            "  set periodic id 0 = 0\n  set periodic id 1 = 1\n end\nend\n"
                            "subsection insertion info\n set insertion method = list\n"
                            " set list x = 9.7e-3, -9.34e-3, 0\n set list y = 0, 0, 0\n"
                            " set list z = 0, 0, -9.52e-3\n"
                            " set list diameters = 1e-3, 1e-3, 1e-3\nend\n"));
  placed.run([](Simulation &simulation) {
    if (simulation.step_number() != 0)
      return;
    const auto all = all_contacts(simulation);
    check("one line a contact", all.size() == 2);
    check("between the first two", all[0][0] == 1. && all[0][1] == 2. && all[0][2] == -1.);
    check_close("overlap across the faces", all[0][3], 4e-5, 1e-12);
    check_relative("force across the faces", all[0][4], hertz(0.25e-3, 4e-5), 1e-9);
    check_close("the line goes on from the first", all[0][5], 9.7e-3 + 0.96e-3, 1e-12);
    check("of the third and the floor", all[1][0] == 3. && all[1][1] == -1. && all[1][2] >= 0.);
    // The wall's modulus and Poisson's ratio are those of the particle.
    check_relative("force on the floor", all[1][4], hertz(0.5e-3, 2e-5), 1e-9);
    check_close("this line ends on it", all[1][7], -0.01, 1e-12);
  });
}

std::string packing(const std::string &more)
{
  return box_input(1e-5, 0.05,
                   "subsection lagrangian physical properties\n set g = 0, 0, -9.81\n"
                   " set friction coefficient wall = 0.3\n"
                   " set restitution coefficient wall = 1\n subsection particle type 0\n"
                   "  set restitution coefficient particles = 1\n"
                   "  set size distribution type = normal\n  set average diameter = 1.5e-3\n"
                   "  set standard deviation = 2e-4\n  set number of particles = 250\n"
                   "  set friction coefficient particles = 0.3\n end\nend\n"
                   "subsection insertion info\n"
                   " set insertion box points coordinates = -0.01,-0.01,-0.01 : 0.01,0.01,0.01\n"
                   " set insertion distance threshold = 1.1\n"
                   " set insertion maximum offset = 0.1\nend\n" +
                       more);
}

void test_packing()
{
  Case seen(packing("")), left_alone(packing(""));
  std::uint64_t n_contacts = 0;
  double worst = 0.;
  seen.run([&](Simulation &simulation) {
    if (simulation.step_number() % 100 != 99)
      return;
    const ParticleArrays &p = simulation.complete_step();
    const auto before = p.force;
    std::vector<Vec3> sums(p.size());
    double scale = 0.;
    for (const ContactForce &c : simulation.contact_forces()) {
      const Vec3 force = c.normal_force * c.normal + c.tangential_force;
      sums[c.first] -= force;
      if (c.second >= 0)
        sums[c.second] += force;
      scale = std::max(scale, norm(force));
      n_contacts += static_cast<std::size_t>(c.first) < p.n_owned ? 1 : 0;
    }
    for (std::size_t k = 0; k < p.n_owned; ++k) {
      // Without damping the forces do not depend on the velocities, which lacked half a step when
      // the forces of the step were computed.
      const Vec3 force = p.force[k].vec() - Vec3{0., 0., -9.81 * p.mass(k)};
      worst = std::max(worst, norm(force - sums[k]) / std::max(scale, 1e-300));
    }
    bool same = true;
    for (std::size_t k = 0; k < p.n_owned; ++k)
      same = same && before[k].vec() == p.force[k].vec();
    if (!same)
      print("to look at contacts changes forces");
  });
  left_alone.run();
  MPI_Allreduce(MPI_IN_PLACE, &n_contacts, 1, MPI_UINT64_T, MPI_SUM, MPI_COMM_WORLD);
  check("many contacts", n_contacts > 500);
  MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  check_close("their sum is the force on each particle", worst, 0., 1e-9);
  check("to look at them changes nothing", particle_table(*seen) == particle_table(*left_alone));
  same_on_one_rank("contacts", [](MPI_Comm comm) {
    Case one(packing(""), comm);
    one.run();
    return all_contacts(*one);
  });
}

} // namespace

EUNOE_MPI_TEST()
{
  test_placed_spheres();
  test_packing();
}
