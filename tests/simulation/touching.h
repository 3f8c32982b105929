#ifndef eunoe_tests_simulation_touching_h
#define eunoe_tests_simulation_touching_h

// Compares all particles with all others: no list may lack a pair that touches.

#include "../tests.h"

#include <set>
#include <utility>

namespace test {

struct Touching
{
  unsigned long n = 0;        ///< pairs that touch, each counted once on every rank
  unsigned long n_missed = 0; ///< those of them of this rank whose contact it does not know

  /// Adds the present pairs; collective.
  /// @param period in z (m)
  void count(Simulation &simulation, const double period)
  {
    const std::vector<ContactForce> contacts = simulation.contact_forces();
    const ParticleArrays &p = simulation.get_system().particles;
    std::set<std::pair<double, double>> known;
    for (const ContactForce &contact : contacts)
      if (contact.second >= 0)
        known.emplace(std::minmax(p.id[contact.first], p.id[contact.second]));
    std::vector<std::vector<double>> mine;
    std::set<double> owned;
    for (std::size_t row = 0; row < p.n_owned; ++row) {
      const Quad &x = p.position[row];
      mine.push_back({static_cast<double>(p.id[row]), x.x, x.y, x.z, x.w});
      owned.insert(p.id[row]);
    }
    const std::vector<std::vector<double>> all = of_all_ranks(simulation.communicator(), mine);
    for (const auto &a : all)
      for (const auto &b : all) {
        const Vec3 apart{a[1] - b[1], a[2] - b[2], std::remainder(a[3] - b[3], period)};
        if (a[0] >= b[0] || norm(apart) > a[4] + b[4] - 1e-12)
          continue;
        ++n;
        const bool is_mine = owned.count(a[0]) + owned.count(b[0]) > 0;
        n_missed += is_mine && known.count({a[0], b[0]}) == 0 ? 1 : 0;
      }
  }
};

} // namespace test

#endif
