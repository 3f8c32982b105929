// A property of materials that a single file adds: it has entries for every particle type, for
// walls and for wall materials, and their values reach the pairs of materials of a law.

#include <eunoe/state/material_property.h>

#include "../tests.h"

using namespace test;

namespace {

const MaterialProperty roughness("roughness", MaterialProperty::Owner::particles_and_walls, 0.25,
                                 {0., 1.}, "Roughness (um).");
const MaterialProperty humidity("humidity", MaterialProperty::Owner::particles, -1., {},
                                "Humidity of particles.");

void read_physics(PhysicalProperties &physics, const std::string &entries)
{
  read_entries([&](dealii::ParameterHandler &prm) { physics.declare(prm); },
               "subsection lagrangian physical properties\n" + entries + "end\n");
}

} // namespace

EUNOE_TEST()
{
  PhysicalProperties physics(2, 2);
  read_physics(physics, " set roughness wall = 0.5\n"
                        " subsection particle type 1\n"
                        "  set roughness particles = 0.75\n"
                        "  set humidity particles = -3\n end\n"
                        " subsection wall material 1\n"
                        "  set roughness wall = 1\n  set friction coefficient wall = 0.7\n end\n");
  const Materials materials = physics.materials();
  std::string values;
  for (int m = 0; m < materials.size(); ++m)
    values += format(roughness(materials[m])) + " ";
  check("types, walls, and wall materials: common and own", values == "0.25 0.75 0.5 0.5 1 ",
        values);
  check("of particles only", humidity(materials[0]) == -1. && humidity(materials[1]) == -3.);
  check("beside a shared property",
        materials[3].friction == physics.wall.friction && materials[4].friction == 0.7);
  const auto table = materials.table(
      [](const Material &a, const Material &b) { return roughness(a) + 10. * roughness(b); });
  check("pairs of materials",
        table[materials.kind(1, 4)] == 0.75 + 10. && table[materials.kind(0, 2)] == 0.25 + 5.);

  const auto refuses = [](const std::string &entry) {
    try {
      PhysicalProperties others(2, 2);
      read_physics(others, entry + "\n");
      return false;
    } catch (const std::exception &) {
      return true;
    }
  };
  check("no number beyond its range", refuses("set roughness wall = 1.5"));
  check("no entry for walls where only particles have it", refuses("set humidity wall = 1"));
  check("a material without entries has the standard", roughness(Material()) == 0.25);
}
