// Two equally charged spheres that approach each other slow down by the potential of the shifted
// Coulomb force, turn back before they touch and leave with the speed with which they came. The
// force acts as soon as the separation is below its range, which exceeds the skin.

#include "../spheres.h"

using namespace test;

EUNOE_MPI_TEST()
{
  const double charge_density = 2e-5, permittivity = 8.8541878128e-12, cut_off = 0.8;
  Scene s;
  s.spheres.resize(2);
  const double radius = s.spheres[0].radius(), mass = 0.5 * s.mass(s.spheres[0]);
  const double charge = 4. * M_PI * radius * radius * charge_density;
  const double strength = charge * charge / (4. * M_PI * permittivity);
  const double end = 2. * radius + cut_off * radius;
  const auto potential = [&](double distance) {
    return distance < end ? strength * (1. / distance - 1. / end - (end - distance) / (end * end))
                          : 0.;
  };
  const double speed = std::sqrt(2. * 0.8 * potential(2. * radius) / mass);
  s.spheres[0].x.z = 1.1 * end;
  s.spheres[0].v.z = -speed;
  s.time_step = 1e-5 * radius / speed;
  s.time_end = 4. * radius / speed;
  s.more = "subsection lagrangian physical properties\nsubsection particle type 0\n" +
           Scene::entry("surface charge density particles", -charge_density) +
           "end\nend\nsubsection model parameters\nsubsection electrostatic charge\n" +
           Scene::entry("cut-off share", cut_off) + "end\nsubsection contact detection\n" +
           Scene::entry("neighborhood threshold", 1.01) + "end\nend\n";
  double worst = 0., nearest = end, last = 0.;
  run(s, [&](Simulation &simulation) {
    const std::vector<Sphere> now = spheres_of(simulation);
    const double distance = norm(now[0].x - now[1].x);
    const double v = now[0].v.z - now[1].v.z;
    const double energy = 0.5 * mass * v * v + potential(distance);
    worst = std::max(worst, std::abs(energy / (0.5 * mass * speed * speed) - 1.));
    nearest = std::min(nearest, distance);
    last = v;
  });
  check_close("energy", worst, 0., 1e-6);
  check("they do not touch", nearest > 2. * radius && nearest < 2.2 * radius);
  check_relative("speed afterwards", last, speed, 1e-6);
}
