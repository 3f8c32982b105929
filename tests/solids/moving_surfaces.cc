// The velocity of a surface at the place of contact, v_c + w x r, acts on a sphere that lies on it.
// References: slipping and then rolling on a belt of velocity U, a = mu g until t = 2 U / (7 mu g),
// then 2/7 U; spin from rolling resistance alone, 5 mu_r g t / (2 R) up to the spin of a drum; a
// turning plate moves spheres as a floor does that turns in place.

#include "surfaces.h"

using namespace test;

namespace {

std::string boundary_input(const std::string &entries)
{
  return "subsection DEM boundary conditions\n set number of boundary conditions = 1\n"
         " subsection boundary condition 0\n set boundary id = 2\n" +
         entries + " end\nend\n";
}

Powder make_powder()
{
  Powder powder;
  powder.gravity = {0., -9.81, 0.};
  powder.friction = 0.3;
  powder.restitution = 0.1;
  return powder;
}

/// A sphere on a belt: the bottom of the domain, whose surface moves, or a plate that moves.
void ride(const std::string &name, const std::string &belt, double height)
{
  const Powder powder = make_powder();
  const double speed = 0.1, a = powder.friction * 9.81, caught = 2. * speed / (7. * a);
  const double y = height + powder.radius() - powder.overlap(powder.mass() * 9.81);
  double worst_velocity = 0., worst_spin = 0., slip = 0.;
  Case test_case(box_input(1e-5, 2. * caught,
                           powder.input() + insertion_input({{{-4e-3, y, 0.}, {}, {}}}) + belt));
  test_case.run([&](Simulation &simulation) {
    const TouchingSphere s = spheres(simulation)[0];
    if (simulation.time() < 0.97 * caught) {
      worst_velocity = std::max(worst_velocity, std::abs(s.velocity.x - a * simulation.time()));
      worst_spin =
          std::max(worst_spin, std::abs(s.spin.z * powder.radius() - 2.5 * a * simulation.time()));
    } else if (simulation.time() > 1.1 * caught)
      slip = std::max(slip, std::abs(s.velocity.x + s.spin.z * powder.radius() - speed));
  });
  const TouchingSphere s = spheres(*test_case)[0];
  check_close(name + ": velocity while it slips", worst_velocity / speed, 0., 1e-12);
  check_close(name + ": spin while it slips", worst_spin / speed, 0., 1e-12);
  // The elastic contact oscillates for a while when it sticks.
  check_close(name + ": no slip then", slip / speed, 0., 1e-4);
  check_relative(name + ": velocity in the end", s.velocity.x, 2. / 7. * speed, 1e-10);
  check_close(name + ": path aside", std::abs(s.position.z) + std::abs(s.position.y - y), 0.,
              1e-12);
}

/// Spheres on a floor that turns about a vertical axis.
std::vector<std::vector<TouchingSphere>> turn(const std::string &floor, double height)
{
  Powder powder = make_powder();
  powder.rolling_friction = 0.1;
  const double y = height + powder.radius() - powder.overlap(powder.mass() * 9.81);
  std::vector<std::vector<TouchingSphere>> track;
  Case test_case(box_input(1e-5, 0.02,
                           powder.input() +
                               insertion_input({{{3e-3, y, 1e-3}, {}, {}},
                                                {{-3e-3, y + 1e-5, -2e-3}, {}, {0., 9., 0.}}}) +
                               floor));
  test_case.run([&](Simulation &simulation) {
    track.push_back(spheres(simulation));
    for (TouchingSphere &s : track.back())
      s.position.y -= height;
  });
  return track;
}

/// A sphere without friction over the axis of a drum; only rolling resistance makes it spin.
void drum()
{
  Powder powder = make_powder();
  powder.friction = 0.;
  powder.rolling_friction = 0.1;
  const double R = powder.radius(), y = -0.01 + R - powder.overlap(powder.mass() * 9.81);
  const double spin = 30., rate = 2.5 * powder.rolling_friction * 9.81 / R, caught = spin / rate;
  double worst = 0., aside = 0.;
  Case test_case(box_input(
      1e-5, 2. * caught,
      powder.input() + insertion_input({{{2e-3, y, 0.}, {}, {}}}) +
          "subsection model parameters\n set rolling resistance torque method = constant\nend\n" +
          boundary_input(" set type = rotational\n set rotational speed = 30\n"
                         " set rotational vector = 0, 0, 1\n"
                         " set point on rotational vector = 2e-3, -0.03, 0\n")));
  test_case.run([&](Simulation &simulation) {
    const TouchingSphere s = spheres(simulation)[0];
    if (simulation.time() < 0.97 * caught)
      worst = std::max(worst, std::abs(s.spin.z - rate * simulation.time()));
    aside = std::max(aside, std::abs(s.spin.x) + std::abs(s.spin.y));
  });
  const TouchingSphere s = spheres(*test_case)[0];
  check_close("drum: spin while it is taken along", worst / spin, 0., 1e-10);
  // At the end the torque changes its sign in every step.
  check_close("drum: spin in the end", s.spin.z, spin, rate * 1e-5);
  check_close("drum: spin about other axes", aside / spin, 0., 1e-12);
  check_close("drum: it stays in its place", std::abs(s.position.x - 2e-3), 0., 1e-15);
}

} // namespace

EUNOE_MPI_TEST()
{
  ride("belt", boundary_input(" set type = translational\n set speed x = 0.1\n"), -0.01);
  ride("plate",
       shape_input("plane", "-9e-3,-2e-3,-4e-3 : 14e-3,0,0 : 0,0,8e-3",
                   motion_input("0.1; 0; 0", "0; 0; 0", {})),
       -2e-3);

  drum();

  const auto floor = turn(boundary_input(" set type = rotational\n set rotational speed = 20\n"
                                         " set rotational vector = 0, -3, 0\n"
                                         " set point on rotational vector = 1e-3, 7, 0\n"),
                          -0.01);
  const auto plate = turn(shape_input("plane", "-5e-3,2e-3,-6e-3 : 12e-3,0,0 : 0,0,12e-3",
                                      motion_input("0; 0; 0", "0; -20; 0", {1e-3, 2e-3, 0.})),
                          2e-3);
  double path = 0., spin = 0.;
  for (std::size_t k = 0; k < floor.size(); ++k)
    for (unsigned int p = 0; p < 2; ++p) {
      path = std::max(path, norm(floor[k][p].position - plate[k][p].position));
      spin = std::max(spin, norm(floor[k][p].spin - plate[k][p].spin));
    }
  check_close("path on a turning plate is that on a turning floor", path, 0., 1e-12);
  check_close("spin on a turning plate is that on a turning floor", spin, 0., 1e-6);
  // w x r = (-w r_z, 0, w r_x) for w along -y.
  const Vec3 moved = floor[100][0].velocity / norm(floor[100][0].velocity);
  const Vec3 r = Vec3{2e-3, 0., 1e-3} / std::sqrt(5e-6);
  check_close("a sphere is taken along with the floor", norm(moved - Vec3{-r.z, 0., r.x}), 0.,
              2e-3);
  check_relative("with the acceleration of friction", norm(floor[100][0].velocity) / 1e-3,
                 0.3 * 9.81, 1e-5);
}
