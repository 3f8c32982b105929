// A sphere that EPSD's spring holds on a slope. As long as the contact keeps its memory, the sphere
// stays; each time the memory is erased, it rolls on as far as at the start, until a new spring
// holds it.

#include "rolling_sphere.h"

using namespace test;

namespace {

constexpr double slope = 0.5 * rolling_friction;

/// Distance down the slope at multiples of an interval of steps (m).
std::vector<double> ways(unsigned int interval, const std::string &more)
{
  Scene s = rolling_scene("epsd", slope, 1.);
  s.time_end = 5 * interval * s.time_step;
  s.more = more;
  std::vector<double> places;
  run(s, [&](Simulation &simulation) {
    if (simulation.step_number() % interval == 0)
      places.push_back(dot(spheres_of(simulation)[0].x, along));
  });
  return places;
}

} // namespace

EUNOE_MPI_TEST()
{
  constexpr unsigned int interval = 20000;
  const std::vector<double> kept = ways(interval, "");
  const double once = kept[1] - kept[0];
  check("the spring gives way at the start", once > 0.);
  check_close("then it holds", (kept[5] - kept[1]) / once, 0., 1e-3);
  const std::vector<double> forgotten =
      ways(interval, "subsection model parameters\n subsection contact history\n"
                     "  set forget interval = " +
                         std::to_string(interval) + "\n end\nend\n");
  for (unsigned int k = 2; k <= 5; ++k)
    check_relative("way " + std::to_string(k), (forgotten[k] - forgotten[k - 1]) / once, 1., 5e-2);
}
