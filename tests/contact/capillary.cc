// Liquid bridges: the force of Willett et al. (2000) with Derjaguin's radius R,
//   F = 2 pi R gamma cos(angle) / (1 + 1.05 s + 2.5 s^2),  s = separation sqrt(R / volume),
// from contact to the rupture distance (1 + angle/2) volume^(1/3) of Lian et al. (1993). Also that
// a bridge forms at contact only, the work of a cycle, and that bridges combine with other laws.

#include "../one_contact.h"

using namespace test;

namespace {

const double tension = 0.072;

std::string liquid(double angle, double share, double volume)
{
  return "subsection capillary bridges\n" + set_entry("surface tension", tension) +
         set_entry("contact angle", angle) + set_entry("volume share", share) +
         set_entry("bridge volume", volume) + "end\n";
}

const ContactModelNames model = {"hertz", {}, "mindlin_limit_overlap", "none"};

/// Two particle types of one material and a wall.
Laws make(const std::string &entries, const ContactModelNames &names = model,
          double largest_radius = 0.)
{
  Material m;
  m.surface_energy = 1e-3;
  return Laws({m, m, m}, 2, names, entries, largest_radius);
}

/// The attraction of a bridge that has formed already.
double attraction(Laws &laws, double radius, double gap, bool wall)
{
  Contact c;
  c.radius = radius;
  c.overlap = -gap;
  c.kind = laws.model.get_materials().kind(0, wall ? 2 : 1);
  c.history[0] = 1.;
  return laws.apply(c, 0.).cohesion;
}

/// @param radius of the particles (m)
void check_curve(const std::string &name, double angle, double share, double volume, double radius,
                 bool wall)
{
  Laws laws = make(liquid(angle, share, volume));
  const double effective = wall ? radius : 0.5 * radius, derjaguin = 2. * effective;
  const double of_bridge = volume > 0. ? volume : share * 4. / 3. * M_PI * radius * radius * radius;
  const double theta = angle * M_PI / 180.;
  const double rupture = (1. + 0.5 * theta) * std::cbrt(of_bridge);
  const auto expected = [&](double gap) {
    const double s = gap * std::sqrt(derjaguin / of_bridge);
    return 2. * M_PI * derjaguin * tension * std::cos(theta) / (1. + 1.05 * s + 2.5 * s * s);
  };
  std::vector<double> force, reference;
  for (int k = 0; k < 100; ++k) {
    const double gap = 0.01 * k * rupture;
    force.push_back(attraction(laws, effective, gap, wall));
    reference.push_back(expected(gap));
  }
  check_close(name + ": force over gap", relative_error(force, reference), 0., 1e-13);
  check_relative(name + ": in contact", attraction(laws, effective, -1e-8, wall), expected(0.),
                 1e-14);
  check(name + ": ends at the rupture distance",
        attraction(laws, effective, (1. - 1e-12) * rupture, wall) > 0. &&
            attraction(laws, effective, (1. + 1e-12) * rupture, wall) == 0.);
  check_relative(name + ": range", make(liquid(angle, share, volume), model, radius).model.range(),
                 rupture, 1e-13);
}

/// Attraction at each separation of a path.
std::vector<double> along(Laws &laws, const std::vector<double> &gaps)
{
  Contact c;
  c.radius = 10e-6;
  c.kind = 1;
  std::vector<double> forces;
  for (const double gap : gaps) {
    c.overlap = -gap;
    forces.push_back(laws.apply(c, 0.).cohesion);
  }
  return forces;
}

} // namespace

EUNOE_TEST()
{
  check_curve("two particles, share", 0., 1e-3, 0., 20e-6, false);
  check_curve("two particles, volume", 30., 1e-3, 1e-18, 20e-6, false);
  check_curve("wall, share", 30., 2e-3, 0., 20e-6, true);
  check_curve("wall, volume", 60., 1e-3, 2e-18, 30e-6, true);

  Laws laws = make(liquid(0., 1e-3, 0.));
  const double volume = 1e-3 * 4. / 3. * M_PI * 8e-15, rupture = std::cbrt(volume);
  const std::vector<double> forces =
      along(laws, {2. * rupture, 0.1 * rupture, 0., 0.5 * rupture, 0.1 * rupture, 1.01 * rupture,
                   0.1 * rupture, -1e-9});
  check("no bridge before contact", forces[0] == 0. && forces[1] == 0.);
  check("a bridge from contact to rupture",
        forces[2] > forces[3] && forces[3] > 0. && forces[4] > forces[3] && forces[5] == 0.);
  check("none after rupture, until they touch again", forces[6] == 0. && forces[7] == forces[2]);

  // Approach, contact and return cost the integral of the force over the separation up to rupture.
  constexpr int n = 2000;
  std::vector<double> path;
  for (int k = 0; k < n; ++k)
    path.push_back((1. - (k + 0.5) / n) * rupture);
  for (int k = 0; k < n; ++k)
    path.push_back((k + 0.5) / n * rupture);
  path.insert(path.begin() + n, 0.);
  double work = 0.;
  for (const double force : along(laws, path))
    work += force * rupture / n;
  work -= along(laws, {0.})[0] * rupture / n;
  const double stretch = std::sqrt(20e-6 / volume), root = std::sqrt(10. - 1.05 * 1.05);
  const double closed =
      2. * M_PI * 20e-6 * tension / stretch * 2. / root *
      (std::atan((5. * stretch * rupture + 1.05) / root) - std::atan(1.05 / root));
  check_relative("work of a cycle", work, closed, 1e-6);

  Laws dmt = make("", {"hertz", {"dmt"}, "mindlin_limit_overlap", "none"});
  Laws both = make(liquid(0., 1e-3, 0.), {"hertz", {"dmt"}, "mindlin_limit_overlap", "none"});
  check_relative("together with DMT", attraction(both, 10e-6, 0., false),
                 attraction(dmt, 10e-6, 0., false) + forces[2], 1e-14);
  Laws jkr = make(liquid(0., 1e-3, 0.), {"jkr", {}, "mindlin_limit_overlap", "epsd"});
  check("together with JKR and EPSD", jkr.model.history_size() == 8);
  check("none by default", dmt.model.history_size() == 3 && make("").model.range() == 0.);

  Contact slides;
  slides.radius = 10e-6;
  slides.overlap = -0.5 * rupture;
  slides.slip = {0., 1., 0.};
  slides.roll = {0., 0., 100.};
  slides.history[0] = 1.;
  const Response r = laws.apply(slides, 1e-6);
  check("neither friction nor torque across a gap",
        r.cohesion > 0. && r.contact_force == 0. && norm(r.shear) == 0. && norm(r.torque) == 0.);
}
