// Head-on impact with linear springs: a damped oscillator from first to last touch. Duration,
// largest overlap and restitution in closed form, at any speed.

#include "../spheres.h"

using namespace test;

EUNOE_MPI_TEST()
{
  for (const double e : {1., 0.5})
    for (const double speed : {0.01, 1.}) {
      Scene scene;
      scene.particle.restitution = e;
      scene.spheres = {Sphere(), Sphere()};
      scene.more = "subsection model parameters\n"
                   " set particle particle contact force method = linear\n"
                   " set particle wall contact force method = linear\nend\n";
      Sphere &a = scene.spheres[0], &b = scene.spheres[1];
      const double mass = 0.5 * scene.mass(a), radius = 0.5 * a.radius();
      const double young = 0.5 * 1e7 / (1. - 0.3 * 0.3);
      const double k = 16. / 15. * std::sqrt(radius) * young *
                       std::pow(15. * mass / (16. * std::sqrt(radius) * young), 0.2);
      const double ratio = e < 1. ? -std::log(e) / std::hypot(std::log(e), M_PI) : 0.;
      const double frequency = std::sqrt(k / mass),
                   damped = frequency * std::sqrt(1. - ratio * ratio);
      const double duration = M_PI / damped;
      const double deepest =
          speed / frequency * std::exp(-ratio / std::sqrt(1. - ratio * ratio) * std::acos(ratio));
      a.x.z = b.x.z + a.diameter;
      a.v.z = -speed;
      scene.time_step = duration / 20000.;
      scene.time_end = 1.5 * duration;
      double overlap = 0., parted = 0., rebound = 0.;
      run(scene, [&](Simulation &simulation) {
        const std::vector<Sphere> s = spheres_of(simulation);
        const double now = a.diameter - (s[0].x.z - s[1].x.z);
        overlap = std::max(overlap, now);
        rebound = s[0].v.z - s[1].v.z;
        if (now > 0.)
          parted = simulation.time();
      });
      const std::string with = "e = " + format(e) + ", " + format(speed) + " m/s: ";
      check_relative(with + "overlap", overlap, deepest, 1e-3);
      check_relative(with + "duration", parted, duration, 1e-3);
      check_relative(with + "restitution", rebound / speed, e, 1e-3);
    }
}
