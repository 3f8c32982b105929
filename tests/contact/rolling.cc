// Rolling resistance. Constant torque: mu_r R |F_n| against the relative spin. Viscous (Zhou et al.
// 1999): mu_r R |F_n| times the speed R |w| of rolling, R w x n (Luding 2008). EPSD of Ai et al.
// (2011): spring 2.25 k_n (mu_r R)^2, its limit, and the damping with either inertia and its
// share f once the spring is mobilised.

#include "../one_contact.h"

using namespace test;

namespace {

const double friction = 0.2, viscous = 0.3, overlap = 1e-6;

Material material()
{
  Material m;
  m.young_modulus = 1e8;
  m.restitution = 0.5;
  m.rolling_friction = friction;
  m.rolling_viscous_damping = viscous;
  m.surface_energy = 0.01;
  return m;
}

Laws laws(const std::string &rolling, const std::string &entries = "")
{
  return Laws({material()}, 1, {"hertz", {"dmt"}, "mindlin_limit_overlap", rolling}, entries);
}

Contact contact(const Vec3 &roll)
{
  Contact c;
  c.normal = {0., 0., 1.};
  c.overlap = overlap;
  c.roll = roll;
  return c;
}

/// First component of the memory that belongs to the rolling law, after Mindlin's three.
constexpr unsigned int first = 3;

Vec3 spring(const Contact &c)
{
  return {c.history[first], c.history[first + 1], c.history[first + 2]};
}

void check_constant()
{
  Laws constant = laws("constant");
  std::vector<Contact> contacts = different_contacts(overlap);
  const std::vector<Response> responses = constant.apply(contacts, 1e-7);
  std::vector<Vec3> torque, reference;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    torque.push_back(responses[k].torque);
    const Vec3 spin = contacts[k].roll + contacts[k].twist * contacts[k].normal;
    reference.push_back(-friction * contacts[k].radius * std::abs(responses[k].contact_force) /
                        norm(spin) * spin);
  }
  check_close("constant: torque against the relative spin, cohesion apart",
              relative_error(torque, reference), 0., 1e-14);
  Contact still = contact({});
  check("constant: no torque without spin", norm(constant.apply(still, 1e-7).torque) == 0.);
}

void check_viscous()
{
  // The two materials differ in one coefficient, so that using a wrong one would show.
  Material other = material();
  other.rolling_friction = 3. * friction;
  Laws viscous_law({material(), other}, 2, {"hertz", {"dmt"}, "mindlin_limit_overlap", "viscous"});
  std::vector<Contact> contacts = different_contacts(overlap);
  for (Contact &c : contacts)
    c.kind = viscous_law.model.get_materials().kind(0, 1);
  const std::vector<Response> responses = viscous_law.apply(contacts, 1e-7);
  std::vector<Vec3> torque, reference;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const Contact &c = contacts[k];
    const Vec3 rolling_velocity = c.radius * cross(c.roll, c.normal);
    // The harmonic mean of 1 and 3 is 1.5.
    const double size =
        1.5 * friction * c.radius * std::abs(responses[k].contact_force) * norm(rolling_velocity);
    torque.push_back(responses[k].torque);
    reference.push_back(-size / norm(c.roll) * c.roll);
  }
  check_close("viscous: torque in proportion to the speed of rolling",
              relative_error(torque, reference), 0., 1e-14);
}

void check_epsd(bool about_contact)
{
  const std::string name =
      std::string("epsd, inertia about the ") + (about_contact ? "contact: " : "centres: ");
  Laws epsd = laws("epsd", std::string("set f coefficient = 0.25\nset epsd inertia = ") +
                               (about_contact ? "contact point" : "centre"));
  const Vec3 roll = {0.6, -0.8, 0.};
  Contact c = contact(roll);
  const Response start = epsd.apply(c, 0.);
  const double arm = friction * c.radius;
  const double stiffness = 2.25 * start.stiffness * arm * arm;
  // About the contact 2/5 m R^2 becomes 7/5 m R^2.
  const double inertia = about_contact ? 3.5 * c.inertia : c.inertia;
  const double damper = 2. * viscous * std::sqrt(inertia * stiffness);
  const double limit = arm * std::abs(start.contact_force);
  check_close(name + "damping alone", relative_error({start.torque}, {-damper * roll}), 0., 1e-14);

  const double dt = 0.1 * limit / stiffness;
  Response r;
  for (int step = 0; step < 5; ++step)
    r = epsd.apply(c, dt);
  check_close(name + "spring", relative_error({spring(c)}, {-0.5 * limit * roll}), 0., 1e-14);
  check_close(name + "spring and damping",
              relative_error({r.torque}, {(-0.5 * limit - damper) * roll}), 0., 1e-14);
  for (int step = 0; step < 20; ++step)
    r = epsd.apply(c, dt);
  check_close(name + "limit of the spring", relative_error({spring(c)}, {-limit * roll}), 0.,
              1e-14);
  check_close(name + "a share of the damping is left at the limit",
              relative_error({r.torque}, {(-limit - 0.25 * damper) * roll}), 0., 1e-14);
  c.roll = -roll;
  r = epsd.apply(c, dt);
  check_close(name + "springs back from the limit with all damping",
              relative_error({r.torque}, {(-0.9 * limit + damper) * roll}), 0., 1e-13);
}

void check_limit()
{
  Laws epsd = laws("epsd");
  check("epsd: no damping is left at the limit by default", [&] {
    Contact c = contact({0., 1., 0.});
    const Response r = epsd.apply(c, 1.);
    return std::abs(norm(r.torque) / (friction * c.radius * r.contact_force) - 1.) < 1e-14;
  }());

  // The limit follows the load, also while nothing turns.
  Contact c = contact({});
  c.history[first] = 1.;
  c.closing_speed = -1e-3;
  const Response r = epsd.apply(c, 0.);
  check_relative("epsd: limit with damping in the normal force", spring(c).x,
                 friction * c.radius * std::abs(r.contact_force), 1e-14);
}

} // namespace

EUNOE_TEST()
{
  check_constant();
  check_viscous();
  check_epsd(true);
  check_epsd(false);
  check_limit();
}
