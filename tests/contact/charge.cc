// Charged particles: Coulomb's force of the charges 4 pi R^2 sigma over the distance of the
// centres, less its value at the cut-off; its sign, where it ends, and that walls exert none.

#include "../one_contact.h"

using namespace test;

namespace {

const double permittivity = 8.8541878128e-12;
const std::string surface_charge = "surface charge density"; ///< a property of one law alone

struct Pair
{
  double r1, r2, charge1, charge2; ///< radii (m), surface charges (C/m2)
};

double repulsion(Laws &laws, const Pair &pair, double gap, int kind)
{
  Contact c;
  c.radius = pair.r1 * pair.r2 / (pair.r1 + pair.r2);
  c.overlap = -gap;
  c.distance = pair.r1 + pair.r2 + gap;
  c.kind = kind;
  return -laws.apply(c, 0.).cohesion;
}

void check_pair(const std::string &name, const Pair &pair)
{
  Material first, second;
  first.added[surface_charge] = pair.charge1;
  second.added[surface_charge] = pair.charge2;
  Laws laws({first, second, Material()}, 2, {"hertz", {}, "mindlin_limit_overlap", "none"},
            "subsection electrostatic charge\n set cut-off share = 1.5\nend\n", 20e-6);
  const double range = 30e-6;
  check_relative(name + ": range", laws.model.range(), range, 1e-14);
  const double q1 = 4. * M_PI * pair.r1 * pair.r1 * pair.charge1;
  const double q2 = 4. * M_PI * pair.r2 * pair.r2 * pair.charge2;
  const auto coulomb = [&](double gap) {
    const double distance = pair.r1 + pair.r2 + gap;
    return q1 * q2 / (4. * M_PI * permittivity * distance * distance);
  };
  std::vector<double> force, reference;
  for (int k = -1; k < 30; ++k) {
    force.push_back(repulsion(laws, pair, k * 1e-6, 1));
    reference.push_back(coulomb(k * 1e-6) - coulomb(range));
  }
  check_close(name + ": force over gap", relative_error(force, reference), 0., 1e-13);
  check(name + ": sign", (force[0] > 0.) == (pair.charge1 * pair.charge2 > 0.));
  check_close(name + ": it ends without a jump",
              repulsion(laws, pair, (1. - 1e-9) * range, 1) / force[0], 0., 1e-8);
  check(name + ": nothing beyond", repulsion(laws, pair, (1. + 1e-12) * range, 1) == 0.);
  check(name + ": nothing at walls",
        repulsion(laws, pair, 1e-6, 2) == 0. && repulsion(laws, pair, -pair.r1 - pair.r2, 2) == 0.);
}

} // namespace

EUNOE_TEST()
{
  check_pair("alike", {20e-6, 20e-6, 1e-5, 1e-5});
  check_pair("of two sizes", {20e-6, 5e-6, -1e-5, -2e-5});
  check_pair("of two signs", {10e-6, 20e-6, 1e-5, -3e-6});

  Material m;
  const ContactModelNames names = {"hertz", {}, "mindlin_limit_overlap", "none"};
  check("none by default", Laws({m}, 1, names, "", 20e-6).model.range() == 0.);
  m.added[surface_charge] = -1e-6;
  check_relative("default range", Laws({m}, 1, names, "", 20e-6).model.range(), 10e-6, 1e-14);
  // As the laws of walls are made.
  ContactParameters contacts;
  read_entries([&](dealii::ParameterHandler &prm) { contacts.declare(prm); }, "");
  const Materials with_wall({m, Material()}, 1);
  check("walls are out of reach", contacts.wall_model(with_wall, 40e-6).range() == 0.);
}
