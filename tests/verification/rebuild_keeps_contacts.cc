// A contact outlives the search for contacts: the motion is the same whether the lists are built
// anew at every step or hardly ever. With slip and rolling that are remembered, with attraction
// across a separation that is wider than the skin, and with necks and liquid bridges that hold only
// because the bodies have touched before. Regression: another program lost cohesive contacts whose
// range exceeds the radii when it built its lists anew, and got values that are not finite where it
// took the damping of cohesive contacts from the restitution.

#include "../spheres.h"

using namespace test;

namespace {

const std::string sticky = "subsection model parameters\n"
                           " set particle particle contact force method = JKR\n"
                           " set particle wall contact force method = JKR\nend\n",
                  wet = "subsection model parameters\nsubsection capillary bridges\n"
                        " set surface tension = 0.02\n set volume share = 1e-3\nend\nend\n";

struct Outcome
{
  std::vector<Sphere> end;
  double widest = 0.; ///< largest separation of the first two spheres (m)
};

Outcome meet(const std::string &laws, const std::string &search)
{
  Scene s;
  s.dmt = laws == "DMT";
  s.rolling = "epsd";
  s.particle.restitution = s.wall.restitution = laws == "DMT" ? 0. : 0.5;
  s.particle.friction = s.wall.friction = 0.4;
  s.particle.rolling_friction = s.wall.rolling_friction = 0.2;
  s.particle.surface_energy = s.wall.surface_energy = 0.02;
  s.particle.hamaker_constant = s.wall.hamaker_constant = 3e-11;
  s.floor = true;
  s.gravity = {0.5, 0., -9.81};
  const double d = Sphere().diameter;
  // Two that spin and meet side by side on the floor, and one that falls on top of them.
  s.spheres = {{{-0.51 * d, 0., 0.4999 * d}, {0.05, 0.02, 0.}, {0., 50., 30.}, d},
               {{0.51 * d, 0., 0.4999 * d}, {-0.05, 0., 0.}, {20., 0., 0.}, d},
               {{0., 0.1 * d, 1.5 * d}, {0., 0., -0.1}, {0., 0., 90.}, d}};
  s.time_step = 2e-6;
  s.time_end = 0.01;
  s.more = (laws == "JKR"       ? sticky
            : laws == "bridges" ? wet
                                : "") +
           "subsection model parameters\nsubsection contact detection\n" +
           Scene::entry("neighborhood threshold", 1.001) +
           Scene::entry("contact detection method", search) + Scene::entry("frequency", "1") +
           "end\nend\n";
  Outcome outcome;
  outcome.end = run(s, [&](Simulation &simulation) {
    const std::vector<Sphere> now = spheres_of(simulation);
    outcome.widest = std::max(outcome.widest, norm(now[0].x - now[1].x) - d);
  });
  return outcome;
}

} // namespace

EUNOE_MPI_TEST()
{
  for (const std::string laws : {"hertz_mindlin", "DMT", "JKR", "bridges"}) {
    const Outcome seldom = meet(laws, "dynamic"), always = meet(laws, "constant");
    double worst = 0.;
    bool finite = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const Sphere &a = seldom.end[k], &b = always.end[k];
      worst =
          std::max({worst, norm(a.x - b.x) / a.diameter, norm(a.v - b.v), norm(a.w - b.w) / 100.});
      finite = finite && std::isfinite(norm(b.x)) && std::isfinite(norm(b.v)) &&
               std::isfinite(norm(b.w));
    }
    check_close(laws + ": same motion with a search at every step", worst, 0., 1e-10);
    check(laws + ": numbers", finite);
    check(laws + ": the pair has parted beyond its skin", always.widest > 1e-6);
  }
}
