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

/// Entries by which contacts forget.
std::string forgetting(unsigned int interval, const std::string &contacts)
{
  return "subsection model parameters\n subsection contact history\n  set forget interval = " +
         std::to_string(interval) + "\n  set forgetful contacts = " + contacts + "\n end\nend\n";
}

/// Slip that is left of an impact of two spheres that stick to each other (m/s).
double slip_after_impact(const std::string &more)
{
  Scene s;
  s.particle.friction = 0.5;
  s.time_end = 5e-4;
  s.more = more;
  s.spheres = {Sphere{{-5.001e-4, 0., 0.}, {0.05, 0.005, 0.}, {}},
               Sphere{{5.001e-4, 0., 0.}, {-0.05, -0.005, 0.}, {}}};
  const std::vector<Sphere> after = run(s);
  return after[0].v.y - after[1].v.y;
}

} // namespace

EUNOE_MPI_TEST()
{
  constexpr unsigned int interval = 20000;
  const std::vector<double> kept = ways(interval, "");
  const double once = kept[1] - kept[0];
  check("the spring gives way at the start", once > 0.);
  check_close("then it holds", (kept[5] - kept[1]) / once, 0., 1e-3);
  const std::vector<double> forgotten = ways(interval, forgetting(interval, "all"));
  for (unsigned int k = 2; k <= 5; ++k)
    check_relative("way " + std::to_string(k), (forgotten[k] - forgotten[k - 1]) / once, 1., 5e-2);
  // Walls and solids alone, or particles alone.
  check("what forgets with solids", ways(interval, forgetting(interval, "solids")) == forgotten);
  check("what does not", ways(interval, forgetting(interval, "particles")) == kept);
  constexpr unsigned int often = 10;
  const double with_memory = slip_after_impact(""),
               without = slip_after_impact(forgetting(often, "all"));
  check("memory matters between particles",
        std::abs(with_memory - without) > 0.1 * std::abs(with_memory));
  check("what forgets between particles",
        slip_after_impact(forgetting(often, "particles")) == without);
  check("what does not there", slip_after_impact(forgetting(often, "solids")) == with_memory);
}
