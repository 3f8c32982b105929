// A period hardly longer than two diameters: two elastic spheres hit each other on both sides in
// turn, across the periodic ends and in the middle, and keep their relative speed. The skin becomes
// smaller than the input asks for.

#include "meshes.h"

using namespace test;

EUNOE_MPI_TEST()
{
  constexpr double d = 1e-3, period = 2.1 * d, v = 0.1, time = 0.02;
  Case test_case(control(1e-6, time) +
                 generated_mesh("hyper_rectangle", "0, 0, 0 : 2.1e-3, 5e-3, 5e-3 : true", 0) +
                 powder(d, 1., 0., "0, 0, 0") +
                 places({{0.55e-3, 2.5e-3, 2.5e-3}, {1.6e-3, 2.5e-3, 2.5e-3}}, {{v, 0., 0.}, {}}) +
                 periodic_in({0}) + R"(
    subsection model parameters
      subsection contact detection
        set neighborhood threshold = 1.5
      end
    end
)");
  unsigned int n_turns = 0;
  double before = 0., last = 1.;
  test_case.run([&](Simulation &simulation) {
    const auto rows = particle_table(simulation);
    const double relative = rows[1][c_vx] - rows[0][c_vx];
    n_turns += relative * before < 0.;
    before = relative;
    last = std::abs(relative);
  });
  // Rigid spheres would fly the rest of the period between two hits; these spend up to a third of
  // the time in contact.
  const double most = time * v / (period - 2. * d);
  check("they hit on both sides in turn", n_turns <= most + 1. && n_turns > 0.6 * most,
        std::to_string(n_turns));
  check("and keep their relative speed", std::abs(last - v) < 1e-4 * v, std::to_string(last));
}
