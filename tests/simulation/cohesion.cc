// DMT cohesion in motion. The attraction acts as soon as the separation is below its range, also
// where the range exceeds the skin, and does the work of the force A R / (6 d^2); the pull-off
// force is 2 pi g R (Meier et al. 2019).

#include "../spheres.h"

using namespace test;

namespace {

const double surface_energy = 0.01, hamaker = 3e-11;

Scene scene(bool floor)
{
  Scene s;
  s.dmt = true;
  s.floor = floor;
  s.particle.friction = s.particle.rolling_friction = 0.5;
  s.particle.restitution = 0.; // the strongest damping
  s.particle.surface_energy = surface_energy;
  s.particle.hamaker_constant = hamaker;
  s.wall = s.particle;
  s.rolling = "epsd";
  // A skin of 1 um.
  s.more = "subsection model parameters\nsubsection contact detection\n" +
           Scene::entry("neighborhood threshold", 1.001) + "end\nend\n";
  return s;
}

void check_approach(const std::string &name, bool floor)
{
  Scene s = scene(floor);
  s.spheres.resize(floor ? 1 : 2);
  Sphere &first = s.spheres[0];
  const double radius = floor ? first.radius() : 0.5 * first.radius();
  const double mass = floor ? s.mass(first) : 0.5 * s.mass(first);
  const double touching = floor ? first.radius() : first.diameter;
  const double pull_off = 2. * M_PI * 2. * surface_energy * radius;
  const double plateau = std::sqrt(hamaker * radius / (6. * pull_off));
  const double cut_off = plateau / std::sqrt(0.1);
  check(name + "range above the skin", cut_off > 10e-6);

  // Approach with slip and spin, which must not change before contact.
  const double speed = 0.02;
  first.v = {0.1, 0., -speed};
  first.w = {100., 200., 0.};
  first.x.z = touching + 1.3 * cut_off;
  if (!floor)
    s.spheres[1].v = {0.1, 0., 0.};
  s.time_step = 2e-8;
  s.time_end = 2. * cut_off / speed;
  double worst = 0., early = 0.;
  bool kept = true, arrived = false;
  run(s, [&](Simulation &simulation) {
    const std::vector<Sphere> now = spheres_of(simulation);
    const Vec3 apart = now[0].x - (floor ? Vec3{now[0].x.x, now[0].x.y, 0.} : now[1].x);
    const double gap = norm(apart) - touching;
    arrived = arrived || gap <= 0.;
    if (arrived)
      return;
    const double v = now[0].v.z - (floor ? 0. : now[1].v.z);
    const double gained = 0.5 * mass * (v * v - speed * speed);
    const double tail = std::min(std::max(gap, plateau), cut_off);
    const double work =
        hamaker * radius / 6. * (1. / tail - 1. / cut_off) + pull_off * std::max(0., plateau - gap);
    if (gap > cut_off)
      early = std::max(early, std::abs(gained));
    worst = std::max(worst, std::abs(gained - work) / (pull_off * plateau));
    kept = kept && now[0].w == first.w && std::abs(now[0].v.x - 0.1) < 1e-14;
  });
  check(name + "they meet", arrived);
  check_close(name + "nothing before the range", early / (pull_off * plateau), 0., 1e-12);
  // The tolerance allows for one step across the jump of the force at the cut-off.
  check_close(name + "kinetic energy is the work of the attraction", worst, 0., 1e-3);
  check(name + "neither friction nor torque before contact", kept);
}

/// Separation at the end of a sphere that the plane attracts and gravity pulls away (m).
double gap_after_pull(double share)
{
  Scene s = scene(true);
  s.spheres.resize(1);
  const double pull_off = 2. * M_PI * 2. * surface_energy * s.spheres[0].radius();
  s.gravity = {0., 0., share * pull_off / s.mass(s.spheres[0])};
  s.spheres[0].x.z = s.spheres[0].radius();
  s.time_end = 10e-3;
  return run(s)[0].x.z - s.spheres[0].radius();
}

} // namespace

EUNOE_MPI_TEST()
{
  check_approach("pair: ", false);
  check_approach("wall: ", true);
  check("hangs on at 99.5 % of the pull-off force", gap_after_pull(0.995) < 0.);
  check("falls at 100.5 % of the pull-off force", gap_after_pull(1.005) > 100e-6);
}
