// Free flight: velocity Verlet follows the parabola to round-off, also for particles that are
// inserted later and need an opening half step, too; Euler's steps err by g t dt / 2, the explicit
// one to the one side and the symplectic one to the other.

#include "../spheres.h"

using namespace test;

namespace {

const Vec3 g = {1.5, -2.5, -9.81}, v0 = {0.2, 0.3, 1.}, w0 = {10., -20., 30.};
const double dt = 1e-5;

/// Five particles from the same place, one every 200 steps.
std::string input(const std::string &integration)
{
  return box_input(
      dt, 1500 * dt,
      "subsection lagrangian physical properties\n"
      " set g = 1.5, -2.5, -9.81\n"
      " subsection particle type 0\n"
      "  set diameter = 0.4e-3\n  set number of particles = 5\n end\nend\n"
      "subsection mesh\n set scale = 8\nend\n"
      "subsection model parameters\n set integration method = " +
          integration +
          "\nend\n"
          "subsection insertion info\n set insertion method = volume\n"
          " set inserted number of particles at each time step = 1\n"
          " set insertion frequency = 200\n"
          " set insertion box points coordinates = -1e-3,-1e-3,-1e-3 : 1e-3,1e-3,1e-3\n"
          " set insertion distance threshold = 5\n"
          " set insertion maximum offset = 0\n"
          " set initial velocity = 0.2, 0.3, 1\n"
          " set initial angular velocity = 10, -20, 30\nend\n");
}

struct Errors
{
  double position = 0., velocity = 0.; ///< over 20 mm and 1 m/s, about the path and the speed
  bool spins = true;
  std::size_t n = 0;
};

/// @param lag how many steps the acceleration lags behind in the position: 1 for explicit Euler, -1
/// for symplectic
Errors fly(const std::string &integration, double lag)
{
  Errors errors;
  Case fall(input(integration));
  std::vector<Vec3> start;
  fall.run([&](Simulation &simulation) {
    const std::vector<Sphere> spheres = spheres_of(simulation);
    if (spheres.size() > start.size())
      start.push_back(spheres.back().x);
    for (std::size_t k = 0; k < spheres.size(); ++k) {
      const double n = static_cast<double>(simulation.step_number()) - 200. * k, t = n * dt;
      const Vec3 x = start[k] + t * v0 + 0.5 * (n * (n - lag)) * dt * dt * g;
      errors.position = std::max(errors.position, norm(spheres[k].x - x) / 20e-3);
      errors.velocity = std::max(errors.velocity, norm(spheres[k].v - v0 - t * g));
      errors.spins = errors.spins && spheres[k].w == w0;
    }
    errors.n = spheres.size();
  });
  return errors;
}

} // namespace

EUNOE_MPI_TEST()
{
  struct Expected
  {
    std::string name, integration;
    double lag;
  };
  for (const auto &[title, integration, lag] :
       {Expected{"velocity Verlet", "velocity_verlet", 0.},
        Expected{"explicit Euler", "explicit_euler", 1.},
        Expected{"symplectic Euler", "symplectic_euler", -1.},
        // What moves does not sleep, even if it may as soon as it rests.
        Expected{"with sleep and no rest time",
                 "velocity_verlet\n subsection adaptive sparse contacts\n"
                 "  set enable adaptive sparse contacts = true\n  set rest time = 0\n end\n",
                 0.}})
  {
    const std::string name = title + ": ";
    const Errors errors = fly(integration, lag);
    check(name + "all five", errors.n == 5);
    // 1500 roundings of either quantity.
    check_close(name + "position", errors.position, 0., 1e-13);
    check_close(name + "velocity", errors.velocity, 0., 1e-13);
    check(name + "spin", errors.spins);
  }
}
