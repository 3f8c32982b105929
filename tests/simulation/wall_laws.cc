// Particles touch walls by other laws than each other, where the input says so: of two pairs and
// two spheres on a floor with the same overlap, only the contacts whose laws have cohesion feel the
// pull-off force. Histories of different sizes go along: with rolling and JKR, over searches.
// Reference: Hertz's force, the pull-off force of DMT.

#include "../spheres.h"

using namespace test;

namespace {

constexpr double R = 0.5e-3, overlap = 1e-7;

Scene scene(const std::string &pairs, const std::string &walls)
{
  Scene s;
  s.spheres = {{{-4e-3, 0., 2e-3}, {}, {}, 2. * R},
               {{-4e-3 + 2. * R - overlap, 0., 2e-3}, {}, {}, 2. * R},
               {{4e-3, 0., R - overlap}, {}, {}, 2. * R}};
  s.floor = true;
  for (Material *m : {&s.particle, &s.wall})
    m->surface_energy = 1e-3;
  s.time_end = s.time_step;
  s.more = "subsection model parameters\n" +
           Scene::entry("particle particle contact force method", pairs) +
           Scene::entry("particle wall contact force method", walls) +
           Scene::entry("rolling resistance torque method", "epsd") + "end\n";
  return s;
}

/// Normal forces of the pair and of the sphere on the floor before the first step (N).
std::pair<double, double> forces(const std::string &pairs, const std::string &walls)
{
  std::pair<double, double> found;
  Case test_case(scene(pairs, walls).text());
  test_case.run([&](Simulation &simulation) {
    if (simulation.step_number() > 0)
      return;
    for (const ContactForce &contact :
         simulation.get_system().contact_forces(simulation.get_solids(), simulation.time()))
      (contact.second < 0 ? found.second : found.first) = contact.normal_force;
  });
  return found;
}

} // namespace

EUNOE_MPI_TEST()
{
  const Material m = scene("DMT", "DMT").particle;
  const double young = m.young_modulus / (2. * (1. - m.poisson_ratio * m.poisson_ratio));
  const auto hertz = [&](double radius) {
    return 4. / 3. * young * std::sqrt(radius) * std::pow(overlap, 1.5);
  };
  const auto pull_off = [&](double radius) {
    return 2. * M_PI * effective_surface_energy(m, m) * radius;
  };
  const auto both = forces("DMT", "DMT");
  check_relative("the pair, DMT", both.first, hertz(0.5 * R) - pull_off(0.5 * R), 1e-6);
  check_relative("the floor, DMT", both.second, hertz(R) - pull_off(R), 1e-6);
  const auto bare_floor = forces("DMT", "nonlinear");
  check("the pair as before", bare_floor.first == both.first);
  check_relative("a floor without cohesion", bare_floor.second, hertz(R), 1e-6);
  const auto bare_pair = forces("hertz", "DMT");
  check_relative("a pair without cohesion", bare_pair.first, hertz(0.5 * R), 1e-6);
  check("the floor as before", bare_pair.second == both.second);

  // A contact of two particles then remembers more than its laws use, or one with a wall does. What
  // only one of the two meets goes its way as if both remembered alike.
  using Row = std::vector<double>;
  const auto rows = [](const std::string &pairs, const std::string &walls) {
    Scene s = scene(pairs, walls);
    s.gravity = {0., 0., -9.81};
    s.time_end = 2000. * s.time_step;
    s.spheres[1].v = {0., 0.1, 0.05};
    s.spheres[2].v = {0.05, 0., 0.};
    Case test_case(s.text());
    test_case.run();
    return particle_table(*test_case);
  };
  const std::vector<Row> longer_wall = rows("hertz", "JKR"), alike = rows("hertz", "nonlinear"),
                         longer_pair = rows("hertz_JKR", "nonlinear");
  check("a pair beside a wall that remembers more",
        longer_wall[0] == alike[0] && longer_wall[1] == alike[1]);
  check("a grain that rolls on a floor beside a pair that remembers more",
        longer_pair[2] == alike[2] && longer_pair[0] != alike[0]);
  check("the floor has other laws", longer_wall[2] != alike[2]);
}
