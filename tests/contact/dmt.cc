// Cohesion of Derjaguin, Muller and Toporov with the long-range part of Meier et al. (2019): the
// curve of force over distance, its numbers for the powders of Gaboriault et al. (2025), and that
// no other force acts across a separation.

#include "../one_contact.h"

using namespace test;

namespace {

struct Powder
{
  const char *name;
  double surface_energy;             ///< of each of the two particles (J/m2)
  double pull_off, plateau, cut_off; ///< as published for 75 um, three digits (N, m, m)
};

double cohesion(Laws &laws, double radius, double gap)
{
  Contact c;
  c.radius = radius;
  c.overlap = -gap;
  return laws.apply(c, 0.).cohesion;
}

void check_powder(const Powder &powder)
{
  const std::string name = powder.name;
  Material m;
  m.surface_energy = powder.surface_energy;
  m.hamaker_constant = 4e-19;
  const double radius = 75e-6 / 4.;
  const double pull_off = 2. * M_PI * (2. * powder.surface_energy) * radius;
  const double plateau = std::sqrt(m.hamaker_constant * radius / (6. * pull_off));

  const double half_digit = 0.5e-2;
  check_relative(name + ": published pull-off force", pull_off, powder.pull_off, half_digit);
  check_relative(name + ": published plateau", plateau, powder.plateau, half_digit);
  for (const double threshold : {0.1, 0.01}) {
    const std::string at = name + " cut at " + (threshold > 0.05 ? "0.1" : "0.01") + ": ";
    Laws laws({m}, 1, {"hertz", {"dmt"}, "mindlin_limit_overlap", "none"},
              set_entry("dmt cut-off threshold", threshold));
    const double cut_off = plateau / std::sqrt(threshold);
    if (threshold > 0.05)
      check_relative(at + "published cut-off", laws.model.range(), powder.cut_off, half_digit);
    check_relative(at + "range", laws.model.range(), cut_off, 1e-14);
    std::vector<double> force, reference;
    for (const double gap : {-1e-6, -1e-9, 0., 0.5 * plateau, (1. - 1e-12) * plateau}) {
      force.push_back(cohesion(laws, radius, gap));
      reference.push_back(pull_off);
    }
    for (const double gap :
         {1.01 * plateau, 1.5 * plateau, 2. * plateau, 3. * plateau, (1. - 1e-12) * cut_off})
    {
      force.push_back(cohesion(laws, radius, gap));
      reference.push_back(m.hamaker_constant * radius / (6. * gap * gap));
    }
    check_close(at + "curve", relative_error(force, reference), 0., 1e-14);
    check_relative(at + "continuous at the plateau", cohesion(laws, radius, (1. + 1e-12) * plateau),
                   pull_off, 1e-11);
    check_relative(at + "share of the pull-off force at the cut-off", force.back(),
                   threshold * pull_off, 1e-11);
    check(at + "nothing beyond", cohesion(laws, radius, (1. + 1e-12) * cut_off) == 0.);
  }
}

} // namespace

EUNOE_TEST()
{
  check_powder({"PS1", 35e-5, 8.25e-8, 3.89e-9, 12.3e-9});
  check_powder({"PS2", 25e-5, 5.89e-8, 4.61e-9, 14.6e-9});
  check_powder({"PS3", 8e-5, 1.88e-8, 8.14e-9, 25.8e-9});

  // Damping (e = 0), friction and rolling resistance are all enabled; none may act across the
  // separation.
  Material m;
  m.restitution = 0.;
  m.surface_energy = 35e-5;
  Laws all({m}, 1, {"hertz", {"dmt"}, "mindlin_limit_overlap", "epsd"});
  Contact c;
  c.overlap = -5e-9;
  c.closing_speed = 0.1;
  c.slip = {0., 0.1, 0.};
  c.roll = {0., 0., 100.};
  c.history.fill(1e-9);
  const Response r = all.apply(c, 1e-7);
  check("only attraction across a gap",
        r.cohesion > 0. && r.contact_force == 0. && norm(r.shear) == 0. && norm(r.torque) == 0.);
  bool forgotten = true;
  for (unsigned int h = 0; h < all.model.history_size(); ++h)
    forgotten = forgotten && c.history[h] == 0.;
  check("no memory across a gap", forgotten);

  // When two particles are parted quasi-statically, the largest attraction is the pull-off force,
  // which acts where the overlap ends.
  double largest = 0.;
  for (int k = 0; k <= 2000; ++k) {
    c = Contact();
    c.overlap = 1e-12 * (1000 - k);
    const Response at = all.apply(c, 0.);
    largest = std::max(largest, at.cohesion - at.contact_force);
  }
  check_relative("pull-off force of a pair", largest, 2. * M_PI * 70e-5 * c.radius, 1e-12);

  // A wall that hardly attracts, whose own range would be long, does not lengthen that of pairs.
  Material wall = m;
  wall.surface_energy = 1e-12;
  const ContactModelNames names{"hertz", {"dmt"}, "mindlin_limit_overlap", "none"};
  check("range of pairs beside a wall",
        Laws({m, wall}, 1, names).model.range() == Laws({m}, 1, names).model.range());

  m.surface_energy = 0.;
  Laws none({m}, 1, {"hertz", {"dmt"}, "mindlin_limit_overlap", "none"});
  check("no surface energy, no cohesion", cohesion(none, 1e-3, 1e-9) == 0. &&
                                              cohesion(none, 1e-3, 0.) == 0. &&
                                              cohesion(none, 1e-3, -1e-9) == 0.);
}
