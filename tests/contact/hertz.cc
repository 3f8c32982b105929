// Normal law: elastic force 4/3 Y sqrt(R d) d, damping coefficient of Tsuji with S_n = 2 Y sqrt(R
// d), no force across a separation. A full block of contacts that all differ, against the formulas.

#include "../one_contact.h"

using namespace test;

EUNOE_TEST()
{
  Material a, b;
  a.young_modulus = 5e8;
  a.poisson_ratio = 0.25;
  a.restitution = 0.8;
  b.young_modulus = 2e7;
  b.poisson_ratio = 0.4;
  b.restitution = 0.4;
  Laws laws({a, b}, 2, {"hertz", {}, "mindlin_limit_overlap", "none"});
  const double young = 1. / ((1. - 0.25 * 0.25) / 5e8 + (1. - 0.4 * 0.4) / 2e7);
  const double log_e = std::log(2. * 0.8 * 0.4 / 1.2);
  const double beta = log_e / std::sqrt(log_e * log_e + M_PI * M_PI);

  std::vector<Contact> contacts = different_contacts(1e-6);
  std::vector<double> stiffness, force, values[2];
  for (Contact &c : contacts) {
    c.kind = laws.model.get_materials().kind(0, 1);
    const double d = std::max(c.overlap, 0.);
    const double slope = 2. * young * std::sqrt(c.radius * d);
    stiffness.push_back(4. / 3. * young * std::sqrt(c.radius * d));
    force.push_back(4. / 3. * young * std::sqrt(c.radius * d * d * d) -
                    2. * std::sqrt(5. / 6.) * beta * std::sqrt(slope * c.mass) * c.closing_speed);
  }
  bool silent = true;
  const std::vector<Response> responses = laws.apply(contacts, 1e-7);
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    values[0].push_back(responses[k].stiffness);
    values[1].push_back(responses[k].contact_force);
    if (contacts[k].overlap <= 0.)
      silent = silent && responses[k].contact_force == 0. && norm(responses[k].shear) == 0.;
  }
  check_close("stiffness", relative_error(values[0], stiffness), 0., 1e-14);
  check_close("force", relative_error(values[1], force), 0., 1e-13);
  check("nothing across a gap", silent);

  // S_n is the slope dF/dd of the elastic force, measured here to check its factor independently.
  Contact deep, deeper;
  deep.kind = deeper.kind = laws.model.get_materials().kind(0, 1);
  deep.overlap = 1e-6 * (1. - 1e-5);
  deeper.overlap = 1e-6 * (1. + 1e-5);
  const double difference =
      laws.apply(deeper, 0.).contact_force - laws.apply(deep, 0.).contact_force;
  Contact moving = deep;
  moving.overlap = 1e-6;
  const double elastic = laws.apply(moving, 0.).contact_force;
  moving.closing_speed = 1.;
  const double damping = laws.apply(moving, 0.).contact_force - elastic;
  check_relative("damping follows the slope of the elastic force", damping,
                 -2. * std::sqrt(5. / 6.) * beta * std::sqrt(difference / 2e-11 * moving.mass),
                 1e-9);
}
