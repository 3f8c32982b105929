// Linear law: springs of constant stiffness, chosen for an impact of 1 m/s, normal and tangential,
// and their dampers. A block of contacts that all differ, against the formulas.

#include "../one_contact.h"

using namespace test;

EUNOE_TEST()
{
  Material a, b;
  a.young_modulus = 5e6;
  a.restitution = 0.8;
  a.friction = b.friction = 1e3; // nothing slides
  b.young_modulus = 2e7;
  b.poisson_ratio = 0.4;
  b.restitution = 0.4;
  Laws laws({a, b}, 2, {"linear", {}, "linear_limit_overlap", "none"});
  const double young = 1. / ((1. - 0.3 * 0.3) / 5e6 + (1. - 0.4 * 0.4) / 2e7);
  const double log_e = std::log(2. * 0.8 * 0.4 / 1.2);
  const double beta = log_e / std::sqrt(log_e * log_e + M_PI * M_PI), dt = 1e-7;

  std::vector<Contact> contacts = different_contacts(1e-6);
  std::vector<double> force, forces;
  std::vector<Vec3> shear, shears;
  for (Contact &c : contacts) {
    c.kind = laws.model.get_materials().kind(0, 1);
    const double k = 16. / 15. * std::sqrt(c.radius) * young *
                     std::pow(15. * c.mass / (16. * std::sqrt(c.radius) * young), 0.2);
    const bool touches = c.overlap > 0.;
    force.push_back(touches ? k * c.overlap - 2. * beta * std::sqrt(k * c.mass) * c.closing_speed
                            : 0.);
    shear.push_back(touches ? (0.4 * k * dt - 2. * beta * std::sqrt(0.4 * k * c.mass)) * c.slip
                            : Vec3());
  }
  for (const Response &response : laws.apply(contacts, dt)) {
    forces.push_back(response.contact_force);
    shears.push_back(response.shear);
  }
  check_close("normal force", relative_error(forces, force), 0., 1e-13);
  check_close("tangential force", relative_error(shears, shear), 0., 1e-13);

  // A contact that slides: the spring stays as long as the Coulomb limit lets it.
  a.friction = b.friction = 0.4;
  a.restitution = b.restitution = 1.;
  Laws sliding({a, b}, 2, {"linear", {}, "linear_limit_overlap", "none"});
  Contact slides;
  slides.kind = sliding.model.get_materials().kind(0, 1);
  slides.overlap = 1e-6;
  slides.slip = {0., 1., 0.};
  Response last;
  for (int k = 0; k < 10; ++k)
    last = sliding.apply(slides, slides.overlap);
  // The tangential stiffness is 0.4 of the normal one.
  check_relative("Coulomb limit", norm(last.shear), 0.4 * last.contact_force, 1e-12);
  check_relative("the spring of a contact that slides",
                 std::hypot(slides.history[0], slides.history[1], slides.history[2]),
                 slides.overlap, 1e-12);

  // The stiffness is chosen so that an undamped impact of 1 m/s reaches the overlap of Hertz's law.
  const double radius = 1e-3, mass = 1e-6;
  const double hertz = std::pow(1.25 * mass / (4. / 3. * young * std::sqrt(radius)), 0.4);
  check_relative("overlap at 1 m/s", std::sqrt(mass / linear_stiffness(young, radius, mass)), hertz,
                 1e-12);
}
