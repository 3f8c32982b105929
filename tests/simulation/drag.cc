// Drag of a still gas. Stokes: the speed decays as exp(-t/tau) with tau = m / (6 pi mu R), and a
// falling sphere approaches g tau. Schiller and Naumann: a sphere falls with the speed at which
// their drag, 1/2 rho v^2 pi R^2 24/Re (1 + 0.15 Re^0.687), equals its weight.

#include "../spheres.h"

using namespace test;

namespace {

Scene scene(double viscosity, double density)
{
  Scene s;
  s.spheres.resize(1);
  s.spheres[0].diameter = 50e-6;
  s.half_width = 0.2;
  s.density = 4000.;
  s.more = "subsection model parameters\nsubsection drag\n" +
           Scene::entry("dynamic viscosity", viscosity) + Scene::entry("density", density) +
           "end\nend\n";
  return s;
}

double relaxation_time(const Scene &s, double viscosity)
{
  const Sphere &sphere = s.spheres[0];
  return s.mass(sphere) / (6. * M_PI * viscosity * sphere.radius());
}

/// Reynolds number of the fall.
double reynolds_of_fall(const std::string &name, double viscosity, double density)
{
  Scene s = scene(viscosity, density);
  s.gravity = {0., 0., -9.81};
  const double tau = relaxation_time(s, viscosity);
  s.spheres[0].x.z = 0.19;
  s.time_end = 20. * tau;
  s.time_step = 1e-3 * tau;
  const double speed = -run(s)[0].v.z;
  const Sphere &sphere = s.spheres[0];
  const double reynolds = density * speed * sphere.diameter / viscosity;
  const double coefficient = 24. / reynolds * (1. + 0.15 * std::pow(reynolds, 0.687));
  check_relative(name + ": drag of a falling sphere",
                 0.5 * density * speed * speed * M_PI * sphere.radius() * sphere.radius() *
                     coefficient,
                 s.mass(sphere) * 9.81, 1e-6);
  return reynolds;
}

} // namespace

EUNOE_MPI_TEST()
{
  const double viscosity = 1.8e-5;
  {
    Scene s = scene(viscosity, 0.);
    const double tau = relaxation_time(s, viscosity);
    const Vec3 v0 = {0.1, -0.05, 0.02}, w0 = {10., 20., 30.};
    s.spheres[0].v = v0;
    s.spheres[0].w = w0;
    s.time_step = 1e-3 * tau;
    s.time_end = 2. * tau;
    double worst = 0.;
    bool spins = true;
    run(s, [&](Simulation &simulation) {
      const Sphere now = spheres_of(simulation)[0];
      const double decayed = std::exp(-simulation.time() / tau);
      worst = std::max({worst, norm(now.v - decayed * v0) / norm(v0),
                        norm(now.x - tau * (1. - decayed) * v0) / (tau * norm(v0))});
      spins = spins && now.w == w0;
    });
    // The drag at the end of a step is that of the velocity in the middle of the step.
    check_close("Stokes: velocity and way", worst, 0., 1e-3);
    check("Stokes: spin is kept", spins);
  }
  {
    Scene s = scene(viscosity, 0.);
    const double tau = relaxation_time(s, viscosity);
    s.gravity = {0., 0., -0.1};
    s.time_step = 1e-3 * tau;
    s.time_end = 20. * tau;
    check_relative("Stokes: speed of a falling sphere", -run(s)[0].v.z, 0.1 * tau, 1e-6);
  }
  const double slow = reynolds_of_fall("air", viscosity, 1.2);
  const double fast = reynolds_of_fall("dense gas", viscosity, 100.);
  check("inertia counts", slow > 0.3 && fast > 10.);
}
