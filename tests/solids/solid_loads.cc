// Force and torque on a solid: the weight of the spheres that rest on it, also in the file of the
// solid; the momentum that a sphere loses in an impact with friction, cohesion and rolling
// resistance goes to the solid.
// Reference: statics; the momentum and the angular momentum of the sphere.

#include <eunoe/core/table.h>

#include "surfaces.h"

using namespace test;

namespace {

const std::string record = "subsection post-processing\n subsection solid forces\n"
                           " set calculation = true\n set filename = loads\n"
                           " set output frequency = 50\n end\nend\n";

struct Load
{
  Vec3 force, torque;
};

Load load_of(const Simulation &simulation)
{
  const std::vector<Solid> &solids = simulation.get_solids();
  const auto plate = std::find_if(solids.begin(), solids.end(),
                                  [](const Solid &solid) { return solid.object == 0u; });
  const SolidLoad load = simulation.global_solid_loads().at(plate - solids.begin());
  return {{load.force[0].value(), load.force[1].value(), load.force[2].value()},
          {load.torque[0].value(), load.torque[1].value(), load.torque[2].value()}};
}

/// Spheres that rest on a plate.
void weigh()
{
  Powder powder;
  powder.gravity = {0., -9.81, 0.};
  powder.restitution = 0.1;
  const double weight = powder.mass() * 9.81, y = powder.radius() - powder.overlap(weight);
  const Vec3 centre = {-2e-3, 1e-3, 5e-3};
  const std::vector<Start> starts = {
      {{-3e-3, y, 2e-3}, {}, {}}, {{1e-3, y + 1e-5, -3e-3}, {}, {}}, {{2e-3, y, 3e-3}, {}, {}}};
  Case test_case(box_input(1e-5, 0.1,
                           powder.input() + insertion_input(starts) + record +
                               shape_input("plane", "-4e-3,0,-4e-3 : 8e-3,0,0 : 0,0,8e-3",
                                           motion_input("0; 0; 0", "0; 0; 0", centre))));
  test_case.run();

  Vec3 torque;
  for (const Start &start : starts)
    torque += cross(start.position - centre, {0., -weight, 0.});
  const Load load = load_of(*test_case);
  check_close("weight on a plate", norm(load.force - Vec3{0., -3. * weight, 0.}) / weight, 0.,
              1e-6);
  check_close("torque about its centre", norm(load.torque - torque) / (1e-3 * weight), 0., 1e-6);

  const Table table =
      parse_table(read_file("results/loads_00.csv", MPI_COMM_WORLD), "loads_00.csv");
  check("columns of the file",
        table.columns ==
            std::vector<std::string>({"time", "f_x", "f_y", "f_z", "T_x", "T_y", "T_z"}));
  check("a row every 50 steps", table.rows.size() == 10000 / 50 + 1);
  bool times = true;
  for (std::size_t k = 0; k < table.rows.size(); ++k)
    times = times && std::abs(table.rows[k][0] - 50e-5 * k) < 1e-12;
  check("their times", times);
  const auto &row = table.rows.back();
  check("last row of the file", Vec3({row[1], row[2], row[3]}) == load.force &&
                                    Vec3({row[4], row[5], row[6]}) == load.torque);
}

/// Oblique impacts on a plate that turns about an axis of its own: with spin, friction, cohesion
/// and rolling resistance.
void exchange_momentum(double plate_spin)
{
  Powder powder;
  powder.friction = 0.3;
  powder.rolling_friction = 0.2;
  powder.surface_energy = 1e-3;
  const Start start = {{0., powder.radius() + 1e-5, 1e-3}, {0.3, -0.2, 0.1}, {200., 100., -300.}};
  const Vec3 centre = {1e-3, -1e-3, 2e-3};
  Vec3 impulse, last_force;
  double worst_torque = 0., largest_torque = 0.;
  const double dt = 1e-6;
  Case test_case(box_input(
      dt, 1.5e-3,
      powder.input() + insertion_input({start}) +
          "subsection post-processing\n subsection solid forces\n set calculation = true\n"
          " set output frequency = 1\n end\nend\n" +
          shape_input("plane", "-4e-3,0,-4e-3 : 8e-3,0,0 : 0,0,8e-3",
                      motion_input("0; 0; 0", "0; " + text_of(plate_spin) + "; 0", centre))));
  test_case.run([&](Simulation &simulation) {
    const TouchingSphere s = spheres(simulation)[0];
    const Load load = load_of(simulation);
    impulse += 0.5 * dt * (load.force + last_force);
    last_force = load.force;
    // The force acts on sphere and solid at points that are the overlap apart.
    const Vec3 torque = load.torque + cross(s.position - centre, s.force) + s.torque;
    const double overlap = std::max(0., powder.radius() - s.position.y);
    const double shear = std::hypot(load.force.x, load.force.z);
    worst_torque = std::max(worst_torque, norm(torque) - 1.000001 * overlap * shear);
    largest_torque = std::max(largest_torque, norm(s.torque));
  });
  const TouchingSphere s = spheres(*test_case)[0];
  check("the impact is over", s.normals.empty() && s.velocity.y > 0.05);
  const Vec3 lost = powder.mass() * (start.velocity - s.velocity);
  check_close("impulse on the plate", norm(impulse - lost) / norm(lost), 0., 1e-12);
  check_close("balance of torques", std::max(0., worst_torque) / largest_torque, 0., 1e-12);
}

} // namespace

EUNOE_MPI_TEST()
{
  weigh();
  exchange_momentum(0.);
  exchange_momentum(30.);
}
