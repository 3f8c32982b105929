// Memory of a contact, Mindlin's displacement and EPSD's torque: it turns with the plane of the
// contact, keeps its length, and ends with the contact.

#include "../one_contact.h"

using namespace test;

namespace {

void check_memory(const std::string &name, const std::string &tangential,
                  const std::string &rolling, unsigned int first)
{
  Material m;
  m.restitution = 1.;
  Laws laws({m}, 1, {"hertz", {}, tangential, rolling});
  Contact c;
  c.normal = {0., 0., 1.};
  c.overlap = 1e-6;
  const auto memory = [&] {
    return Vec3{c.history[first], c.history[first + 1], c.history[first + 2]};
  };
  // So short that no limit is reached.
  const double length = 1e-15;
  c.history[first] = 0.6 * length;
  c.history[first + 1] = 0.8 * length;
  const int n_steps = 9000;
  double out_of_plane = 0.;
  for (int step = 1; step <= n_steps; ++step) {
    const double angle = 0.5 * M_PI * step / n_steps;
    c.normal = {0., -std::sin(angle), std::cos(angle)};
    laws.apply(c, 1e-8);
    out_of_plane = std::max(out_of_plane, std::abs(dot(memory(), c.normal)));
  }
  check_relative(name + ": length after the plane has turned", norm(memory()), length, 1e-13);
  check_close(name + ": it lies in the plane", out_of_plane / length, 0., 1e-14);
  // The plane turns about x: the component of the memory along x stays, that along y follows the
  // plane. Projection shortens only the latter, by the cosine of the angle of a step, and restoring
  // the length stretches both: the direction errs by up to (pi/2)^2 / 4 / n_steps.
  check_close(name + ": direction after the plane has turned",
              relative_error({memory()}, {{0.6 * length, 0., 0.8 * length}}), 0., 1e-4);

  c.overlap = -1e-9;
  Response r = laws.apply(c, 1e-8);
  check(name + ": no force and no memory out of contact",
        norm(r.shear) == 0. && norm(r.torque) == 0. && norm(memory()) == 0.);
  c.history[first + 2] = length;
  c.overlap = 1e-6;
  c.normal = {0., 0., 1.};
  r = laws.apply(c, 0.);
  check(name + ": what lies along the normal vanishes",
        norm(r.shear) == 0. && norm(r.torque) == 0. && norm(memory()) == 0.);
}

} // namespace

EUNOE_TEST()
{
  check_memory("limit overlap", "mindlin_limit_overlap", "none", 0);
  check_memory("limit force", "mindlin_limit_force", "none", 0);
  check_memory("epsd", "mindlin_limit_overlap", "epsd", 3);
}
