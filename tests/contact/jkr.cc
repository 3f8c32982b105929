// Adhesion of Johnson, Kendall and Roberts: the curve of force over distance, given by the contact
// radius a as
//   overlap = a^2/R - sqrt(2 pi w a / E),  F = 4/3 E a^3/R - sqrt(8 pi w E a^3),
// its pull-off force 3/2 pi w R, where it begins and where it ends, and the work that a cycle
// costs, 7.09 (w^5 R^4 / E^2)^(1/3) (Thornton, Ning 1998). Without adhesion it is Hertz's contact.

#include "../one_contact.h"

using namespace test;

namespace {

const ContactModelNames jkr = {"jkr", {}, "mindlin_limit_overlap", "epsd"};
const ContactModelNames hertz = {"hertz", {}, "mindlin_limit_overlap", "epsd"};

/// A contact according to the theory.
struct Theory
{
  double radius, young, work; ///< effective radius (m), modulus (Pa), work of adhesion (J/m2)

  double overlap(double a) const
  {
    return a * a / radius - std::sqrt(2. * M_PI * work * a / young);
  }
  double force(double a) const
  {
    return 4. / 3. * young * a * a * a / radius - std::sqrt(8. * M_PI * work * young * a * a * a);
  }
  /// Contact radius at the least overlap, where the neck tears (m).
  double torn() const { return std::cbrt(M_PI * work * radius * radius / (8. * young)); }
  double pull_off() const { return 1.5 * M_PI * work * radius; }
};

Material material(double surface_energy)
{
  Material m;
  m.young_modulus = 5e6;
  m.surface_energy = surface_energy;
  m.restitution = 1.;
  return m;
}

Laws make(const ContactModelNames &names, const Material &m, double largest_radius = 0.)
{
  return Laws({m}, 1, names, "", largest_radius);
}

/// Force on j without damping, repulsion positive.
double force_at(Laws &laws, Contact &c, double overlap)
{
  c.overlap = overlap;
  const Response r = laws.apply(c, 0.);
  return r.contact_force - r.cohesion;
}

void check_curve(const std::string &name, double radius, double surface_energy)
{
  const Material m = material(surface_energy);
  const Theory theory = {radius, m.young_modulus / (2. * (1. - 0.09)), 2. * surface_energy};
  Laws laws = make(jkr, m);
  std::vector<double> force, reference, areas, contact_radii;
  for (double x = 1.01; x < 1e3; x *= 1.02) {
    const double a = x * theory.torn();
    Contact c;
    c.radius = radius;
    c.history[0] = 1.;
    c.overlap = theory.overlap(a);
    const Response r = laws.apply(c, 0.);
    force.push_back((r.contact_force - r.cohesion) / (theory.pull_off() + theory.force(a)));
    reference.push_back(theory.force(a) / (theory.pull_off() + theory.force(a)));
    areas.push_back(r.stiffness / a);
    contact_radii.push_back(4. / 3. * theory.young);
  }
  check_close(name + ": force over overlap", relative_error(force, reference), 0., 1e-12);
  check_close(name + ": contact radius", relative_error(areas, contact_radii), 0., 1e-12);

  double deepest = 0.;
  Contact c;
  c.radius = radius;
  c.history[0] = 1.;
  const double end = -theory.overlap(theory.torn());
  for (int k = 0; k < 100100; ++k)
    deepest = std::min(deepest, force_at(laws, c, end * (1. - 2e-5 * k)));
  check(name + ": it has torn", c.history[0] == 0.);
  check_relative(name + ": pull-off force", -deepest, theory.pull_off(), 1e-8);
  check_relative(name + ": neck at its end", end, 3. * theory.torn() * theory.torn() / radius,
                 1e-13);
  c.history[0] = 1.;
  // The tolerance is larger, as the slope of the force is infinite there.
  check_relative(name + ": force at its end", force_at(laws, c, -end * (1. - 1e-14)),
                 -5. / 9. * theory.pull_off(), 1e-6);
  c.history[0] = 0.;
  check_relative(name + ": force at first touch", force_at(laws, c, 1e-13 * end),
                 -8. / 9. * theory.pull_off(), 1e-12);
  check_relative(name + ": range", make(jkr, m, radius).model.range(), end, 1e-13);
}

/// Work of making, pressing and parting a contact (J), by Simpson's rule.
double work_of_cycle(Laws &laws, const Theory &theory)
{
  const double neck = 3. * theory.torn() * theory.torn() / theory.radius, pressed = 2. * neck;
  constexpr int n = 20000;
  Contact c;
  c.radius = theory.radius;
  double work = 0.;
  const auto path = [&](double from, double to) {
    for (int k = 0; k < n; ++k) {
      const double s[] = {(k + 1e-9) / n, (k + 0.5) / n, (k + 1. - 1e-9) / n};
      const double weight[] = {1. / 6., 4. / 6., 1. / 6.};
      for (int l = 0; l < 3; ++l) {
        // Points are denser towards the ends, where the force has an infinite slope.
        const double share = s[l] * s[l] * (3. - 2. * s[l]);
        const double density = 6. * s[l] * (1. - s[l]);
        work +=
            weight[l] / n * density * (to - from) * force_at(laws, c, from + share * (to - from));
      }
    }
  };
  path(-2. * neck, 0.);
  path(0., pressed);
  path(pressed, 0.);
  path(0., -neck);
  path(-neck, -2. * neck);
  return work;
}

void check_friction()
{
  Material m = material(0.02);
  m.friction = 0.3;
  m.rolling_friction = 0.1;
  const Theory theory = {1e-3, m.young_modulus / (2. * (1. - 0.09)), 0.04};
  Laws laws = make(jkr, m);
  for (const double x : {1.5, std::pow(4., 2. / 3.), 20.}) {
    Contact c;
    c.history[0] = 1.;
    c.overlap = theory.overlap(x * theory.torn());
    c.slip = {0., 1., 0.};
    c.roll = {0., 0., 1e4};
    const double felt = theory.force(x * theory.torn()) + 2. * theory.pull_off();
    const Response r = laws.apply(c, 1e-3);
    const std::string at = x < 2. ? "in the neck" : x < 3. ? "at touch" : "deep";
    check_relative("friction of an adhesive contact " + at, norm(r.shear), 0.3 * felt, 1e-9);
    check_relative("rolling resistance of an adhesive contact " + at, norm(r.torque),
                   0.1 * theory.radius * felt, 1e-9);
    // A displacement so small that the Coulomb limit is not reached.
    const double length = 1e-15;
    c.slip = c.roll = {};
    c.history.fill(0.);
    c.history[0] = 1.;
    c.history[2] = length;
    const double shear_modulus = m.young_modulus / (4. * (2. - 0.3) * (1. + 0.3));
    check_relative("tangential stiffness of an adhesive contact " + at,
                   norm(laws.apply(c, 0.).shear), 8. * shear_modulus * x * theory.torn() * length,
                   1e-9);
  }
}

void check_without_adhesion()
{
  Material m = material(0.);
  m.restitution = 0.4;
  m.friction = 0.3;
  Laws with = make(jkr, m, 1e-3), without = make(hertz, m);
  std::vector<Contact> adhesive = different_contacts(1e-5), plain = adhesive;
  std::vector<double> forces, references;
  std::vector<Vec3> shear, shear_references;
  const std::vector<Response> a = with.apply(adhesive, 1e-7), b = without.apply(plain, 1e-7);
  bool apart = true;
  for (std::size_t k = 0; k < a.size(); ++k) {
    forces.push_back(a[k].contact_force - a[k].cohesion);
    references.push_back(b[k].contact_force);
    shear.push_back(a[k].shear);
    shear_references.push_back(b[k].shear);
    apart = apart && (plain[k].overlap > 0. || (forces.back() == 0. && norm(shear.back()) == 0.));
  }
  check_close("without adhesion: Hertz's force", relative_error(forces, references), 0., 1e-14);
  check_close("without adhesion: friction", relative_error(shear, shear_references), 0., 1e-13);
  check("without adhesion: nothing across a gap", apart && with.model.range() == 0.);
}

} // namespace

EUNOE_TEST()
{
  check_curve("soft, large", 1e-3, 0.02);
  check_curve("powder", 10e-6, 2e-4);
  check_curve("hardly adhesive", 20e-6, 1e-12);

  const Material m = material(0.02);
  const Theory theory = {1e-3, m.young_modulus / (2. * (1. - 0.09)), 0.04};
  const double neck = 3. * theory.torn() * theory.torn() / theory.radius;
  Laws laws = make(jkr, m);
  Contact c;
  check("nothing before the first touch",
        force_at(laws, c, -0.01 * neck) == 0. && force_at(laws, c, 0.) == 0. && c.history[0] == 0.);
  check("attraction across a gap after it",
        force_at(laws, c, 1e-12) < 0. && force_at(laws, c, -0.99 * neck) < 0.);
  check("none beyond the neck, nor on the way back",
        force_at(laws, c, -1.000001 * neck) == 0. && force_at(laws, c, -0.99 * neck) == 0.);
  const double scale =
      std::cbrt(std::pow(theory.work, 5) * std::pow(theory.radius, 4) / std::pow(theory.young, 2));
  // The integral from the contact radius of the torn neck to 4^(2/3) times it, the contact radius
  // at zero overlap, in closed form.
  const double closed = (4.8 * std::pow(4., 4. / 3.) + 3.2) * std::pow(M_PI / 8., 5. / 3.);
  check_relative("published work of a cycle", closed, 7.09, 1e-3);
  check_relative("work of a cycle", work_of_cycle(laws, theory) / scale, closed, 1e-6);
  check_friction();
  check_without_adhesion();
}
