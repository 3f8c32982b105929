// A sphere that EPSD's spring holds on a slope. With its memory it stays; each time that the
// contact forgets, it rolls on until a new spring holds it: as far as at the start.

#include "../spheres.h"

using namespace test;

namespace {

constexpr double g = 9.81, rolling_friction = 0.1, slope = 0.5 * rolling_friction;
const Vec3 along = {1., 0., 0.};

/// Way down the slope at the multiples of an interval (m).
std::vector<double> ways(unsigned int interval, const std::string &more)
{
  Scene s;
  s.floor = true;
  s.rolling = "epsd";
  s.time_step = 1e-6;
  s.particle.restitution = 0.5;
  s.particle.friction = 0.5;
  s.particle.rolling_friction = rolling_friction;
  s.particle.rolling_viscous_damping = 1.;
  s.wall = s.particle;
  const double angle = std::atan(slope);
  s.gravity = g * std::sin(angle) * along - Vec3{0., 0., g * std::cos(angle)};
  s.spheres = {resting_sphere(s)};
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

int main(int argc, char **argv)
{
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
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
