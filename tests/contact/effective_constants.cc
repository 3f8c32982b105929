// Effective constants of a pair of materials, and that every kind of pair gets its own. References:
// Hertz's and Mindlin's theory in the form with the shear modulus, harmonic means, and the time
// step that Gaboriault et al. (2025) state for their powder.

#include <eunoe/state/physical_properties.h>

#include "../one_contact.h"

using namespace test;

namespace {

double shear_modulus(const Material &m)
{
  return m.young_modulus / (2. * (1. + m.poisson_ratio));
}

void check_pair(const Material &a, const Material &b)
{
  check_relative("Young's modulus of two equal bodies", effective_young_modulus(a, a),
                 a.young_modulus / (2. * (1. - a.poisson_ratio * a.poisson_ratio)), 1e-15);
  Material rigid = b;
  rigid.young_modulus = 1e300;
  check_relative("Young's modulus against a rigid body", effective_young_modulus(a, rigid),
                 a.young_modulus / (1. - a.poisson_ratio * a.poisson_ratio), 1e-15);
  check_relative("shear modulus of two equal bodies", effective_shear_modulus(a, a),
                 shear_modulus(a) / (2. * (2. - a.poisson_ratio)), 1e-15);
  check_relative(
      "shear modulus of two unlike bodies", 1. / effective_shear_modulus(a, b),
      (2. - a.poisson_ratio) / shear_modulus(a) + (2. - b.poisson_ratio) / shear_modulus(b), 1e-15);
  const double difference = std::sqrt(a.surface_energy) - std::sqrt(b.surface_energy);
  check_relative("surface energy", effective_surface_energy(a, b),
                 a.surface_energy + b.surface_energy - difference * difference, 1e-14);
  check_relative("Hamaker constant", effective_hamaker_constant(a, b),
                 0.5 * (a.hamaker_constant + b.hamaker_constant), 1e-15);
}

/// Hertz's secant stiffness, the Coulomb limit of a fast slide, the pull-off force and the constant
/// rolling torque of all kinds of pairs in one block.
void check_every_kind(const std::vector<Material> &materials, int n_types)
{
  const double overlap = 1e-7, radius = 1e-3;
  Laws laws(materials, n_types, {"hertz", {"dmt"}, "mindlin_limit_overlap", "constant"});
  std::vector<Contact> contacts;
  std::vector<double> stiffness, friction, pull_off, torque, values[4];
  double range = 0.;
  for (int a = 0; a < n_types; ++a)
    for (int b = 0; b < static_cast<int>(materials.size()); ++b) {
      const Material &m = materials[a], &n = materials[b];
      Contact c;
      c.overlap = overlap;
      c.radius = radius;
      c.slip = {0., 100., 0.};
      c.roll = {0., 0., 1.};
      c.kind = laws.model.get_materials().kind(a, b);
      contacts.push_back(c);
      const double k = 4. / 3. * effective_young_modulus(m, n) * std::sqrt(radius * overlap);
      stiffness.push_back(k);
      friction.push_back(2. / (1. / m.friction + 1. / n.friction) * k * overlap);
      pull_off.push_back(4. * M_PI * std::sqrt(m.surface_energy * n.surface_energy) * radius);
      torque.push_back(-2. / (1. / m.rolling_friction + 1. / n.rolling_friction) * radius * k *
                       overlap);
    }
  for (const Material &m : materials)
    for (const Material &n : materials)
      range =
          std::max(range, std::sqrt((m.hamaker_constant + n.hamaker_constant) / 12. / 0.1 /
                                    (4. * M_PI * std::sqrt(m.surface_energy * n.surface_energy))));
  for (const Response &r : laws.apply(contacts, 1.)) {
    values[0].push_back(r.stiffness);
    values[1].push_back(r.shear.y);
    values[2].push_back(r.cohesion);
    values[3].push_back(r.torque.z);
  }
  check_close("stiffness of every kind", relative_error(values[0], stiffness), 0., 1e-14);
  check_close("friction of every kind", relative_error(values[1], friction), 0., 1e-14);
  check_close("cohesion of every kind", relative_error(values[2], pull_off), 0., 1e-14);
  check_close("rolling friction of every kind", relative_error(values[3], torque), 0., 1e-14);
  check_relative("range of all kinds", laws.model.range(), range, 1e-14);
}

} // namespace

EUNOE_TEST()
{
  const Material steel = {210e9, 0.28, 0.9, 0.5, 0.01, 0.3, 1.2, 2e-19};
  const Material rubber = {2e6, 0.5, 0.4, 1.1, 0.2, 0.1, 0.03, 5e-20};
  const Material glass = {70e9, 0.22, 0.7, 0.2, 0.05, 0.2, 0.3, 7e-20};
  check_pair(steel, rubber);

  check("mean of two equal numbers", harmonic_mean(0.9, 0.9) == 0.9);
  check_relative("harmonic mean", harmonic_mean(0.3, 0.6), 0.4, 1e-15);
  check("mean with zero", harmonic_mean(0., 0.5) == 0. && harmonic_mean(0., 0.) == 0.);

  // The damped oscillator to which Tsuji's contact maps has the damping ratio -beta, and an
  // oscillator that stops at its next zero has a restitution of exp(-pi D / sqrt(1 - D^2)).
  for (const double e : {0.05, 0.3, 0.9}) {
    const double d = damping_factor(e) / (2. * std::sqrt(5. / 6.));
    check_relative("damping ratio for e = " + format(e),
                   std::exp(-M_PI * d / std::sqrt(1. - d * d)), e, 1e-13);
  }
  check_close("no damping for e = 1", damping_factor(1.), 0., 0.);
  check_relative("critical damping for e = 0", damping_factor(0.), 2. * std::sqrt(5. / 6.), 1e-15);

  check_every_kind({steel, rubber, glass}, 2);

  Material titanium;
  titanium.young_modulus = 26.25e6;
  titanium.poisson_ratio = 0.342;
  check_relative("15 % of the Rayleigh time of the paper's powder",
                 0.15 * PhysicalProperties::rayleigh_time(26.311e-6, 4386., titanium), 2.816e-7,
                 0.5e-3 / 2.816);

  // Two spheres of radius R overlap by 0.01 R: Y* = Y / (2 (1 - nu^2)), R* = R / 2, m* = m / 2.
  PhysicalProperties physics;
  ParticleType &type = physics.types[0];
  type.material = titanium;
  type.density = 4386.;
  type.sizes.average_diameter = 2e-4;
  physics.wall = titanium;
  const double mass = 4. / 3. * M_PI * 1e-12 * 4386.;
  const double young = 26.25e6 / (2. * (1. - 0.342 * 0.342));
  check_relative("contact time of two particles", physics.shortest_contact_time(type, 1e-4, {}),
                 M_PI * std::sqrt(0.5 * mass / (2. * young * std::sqrt(0.5e-4 * 1e-6))), 1e-12);
  // The linear law at R* and m*, whatever the overlap: k = s (m* / s)^(1/5), s = 16/15 sqrt(R*) Y*.
  const double spring = 16. / 15. * std::sqrt(0.5e-4) * young;
  check_relative("contact time of two particles of the linear law",
                 physics.shortest_contact_time(type, 1e-4, {true, true}),
                 M_PI * std::sqrt(0.5 * mass / (spring * std::pow(0.5 * mass / spring, 0.2))),
                 1e-12);
  // With a wall of the same material the stiffness grows by a factor sqrt(2) and the mass by 2. A
  // rigid wall also doubles the modulus, so that the contact with the wall is the shorter one.
  physics.wall.young_modulus = 1e16;
  check_relative("contact time with a rigid wall", physics.shortest_contact_time(type, 1e-4, {}),
                 M_PI * std::sqrt(mass / (4. * young * std::sqrt(1e-4 * 1e-6))), 1e-8);
}
