// Tangential law: stiffness 8 G sqrt(R d) and damping while it sticks, the Coulomb limit without
// cohesion, and the displacement that each variant keeps after a slide.

#include "../one_contact.h"

using namespace test;

namespace {

const double overlap = 1e-6, radius = 1e-3, mass = 1e-6;

Material material(double restitution)
{
  Material m;
  m.young_modulus = 5e7;
  m.poisson_ratio = 0.3;
  m.restitution = restitution;
  m.friction = 0.4;
  m.surface_energy = 0.01;
  return m;
}

Laws laws(const std::string &variant, double restitution)
{
  return Laws({material(restitution)}, 1, {"hertz", {"dmt"}, "mindlin_" + variant, "none"});
}

Contact contact(const Vec3 &slip)
{
  Contact c;
  c.normal = {0., 0., 1.};
  c.overlap = overlap;
  c.radius = radius;
  c.mass = mass;
  c.slip = slip;
  return c;
}

Vec3 spring(const Contact &c)
{
  return {c.history[0], c.history[1], c.history[2]};
}

const double shear_modulus = 5e7 / (2. * 1.3);
const double stiffness = 8. * shear_modulus / (2. * (2. - 0.3)) * std::sqrt(radius * overlap);

/// A variant of the law.
struct Variant
{
  std::string name;
  bool springs_back; ///< whether the spring keeps no more than the Coulomb limit allows
  bool damps;
};

/// Damping coefficient of the variants with damping (N s/m).
double damping_of(double restitution)
{
  const double log_e = std::log(restitution);
  return -2. * std::sqrt(5. / 6.) * log_e / std::sqrt(log_e * log_e + M_PI * M_PI) *
         std::sqrt(stiffness * mass);
}
const double limit =
    0.4 * 4. / 3. * 5e7 / (2. * (1. - 0.09)) * std::sqrt(radius * overlap) * overlap;

void check_sticking(const Variant &law)
{
  const std::string &variant = law.name;
  Laws elastic = laws(variant, 1.);
  Contact c = contact({0.3, -0.4, 0.});
  Vec3 force;
  for (int step = 0; step < 5; ++step)
    force = elastic.apply(c, 1e-8).shear;
  check_close(variant + ": spring while it sticks",
              relative_error({force}, {stiffness * 5e-8 * c.slip}), 0., 1e-14);
  c.overlap *= 0.25;
  force = elastic.apply(c, 0.).shear;
  check_close(variant + ": softer at a quarter of the overlap",
              relative_error({force}, {0.5 * stiffness * 5e-8 * c.slip}), 0., 1e-14);

  Laws damped = laws(variant, 0.5);
  c = contact({3e-3, -4e-3, 0.});
  force = damped.apply(c, 1e-8).shear;
  const double damper = law.damps ? damping_of(0.5) : 0.;
  check_close(variant + ": damping while it sticks",
              relative_error({force}, {(stiffness * 1e-8 + damper) * c.slip}), 0., 1e-14);
}

/// A slide much longer than the displacement at the Coulomb limit, then a small step back.
void check_sliding(const Variant &law)
{
  const std::string &variant = law.name;
  const bool springs_back = law.springs_back;
  Laws elastic = laws(variant, 1.);
  Contact c = contact({0.6, 0.8, 0.});
  const double most = limit / stiffness;
  Response r;
  for (int step = 0; step < 10; ++step)
    r = elastic.apply(c, most);
  check(variant + ": cohesion is there", r.cohesion > 0.1 * r.contact_force);
  check_close(variant + ": Coulomb limit along the slip, without cohesion",
              relative_error({r.shear}, {limit * c.slip}), 0., 1e-14);
  check_close(variant + ": what is remembered of the slide",
              relative_error({spring(c)}, {(springs_back ? 1. : 10.) * most * c.slip}), 0., 1e-13);
  const Vec3 forwards = c.slip;
  c.slip = -forwards;
  r = elastic.apply(c, 0.25 * most);
  check_close(variant + ": force a quarter of the spring's reach back",
              relative_error({r.shear}, {(springs_back ? 0.75 : 1.) * limit * forwards}), 0.,
              1e-13);

  // With damping the limit holds for the whole force, and the spring gets what the damper leaves.
  Laws damped = laws(variant, 0.5);
  c = contact(0.01 * forwards);
  c.history[0] = 6. * most;
  c.history[1] = 8. * most;
  r = damped.apply(c, 0.);
  check_relative(variant + ": limit with damping", norm(r.shear), limit, 1e-14);
  const double left = limit - (law.damps ? damping_of(0.5) : 0.) * norm(c.slip);
  check_relative(variant + ": spring and damper together at the limit", norm(spring(c)),
                 springs_back ? left / stiffness : 10. * most, 1e-13);

  // The limit includes the normal damping force and follows the magnitude of the normal force.
  c = contact({0., 100., 0.});
  c.closing_speed = -10.;
  r = damped.apply(c, 1.);
  check(variant + ": parts with an attractive damper", r.contact_force < 0.);
  check_relative(variant + ": limit is that of the size of the force", r.shear.y,
                 -0.4 * r.contact_force, 1e-14);
}

} // namespace

EUNOE_TEST()
{
  for (const Variant &law :
       {Variant{"limit_overlap", true, true}, Variant{"limit_force", false, true},
        Variant{"undamped", false, false}})
  {
    check_sticking(law);
    check_sliding(law);
  }
}
