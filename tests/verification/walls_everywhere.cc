// A wall is found in time everywhere: beside its edges, in every kind of mesh cell, from any
// direction, also by a sphere that came through many mesh cells. Each elastic rebound has the
// overlap and the speed of Hertz's theory. Regression: another program found walls too late in mesh
// cells that touch them with an edge only, and shot particles off.

#include "../spheres.h"

using namespace test;

namespace {

const double half = 5e-3, speed = 2.;

/// Largest relative errors of overlap and speed of spheres that fly along an axis.
struct Errors
{
  double overlap = 0., speed = 0., sideways = 0.;
};

Errors rebound(unsigned int axis, double direction, const std::string &search)
{
  Scene s;
  s.half_width = half;
  Sphere sphere;
  const double radius = sphere.radius(), side = half - 1.0001 * radius;
  // Columns beside the walls, over the edges of mesh cells, and anywhere.
  const double places[] = {-side, -0.5 * half, -0.15 * half, 0.27 * half, side};
  for (const double a : places)
    for (const double b : places) {
      sphere.x[axis] = -0.3 * direction * half;
      sphere.x[(axis + 1) % 3] = a;
      sphere.x[(axis + 2) % 3] = b;
      sphere.v = {};
      sphere.v[axis] = direction * speed;
      s.spheres.push_back(sphere);
    }
  const Impact hertz(s.particle, s.wall, s.mass(sphere), radius, speed);
  s.time_step = hertz.duration() / 200.;
  s.time_end = (1.3 * half - radius) / speed + 2. * hertz.duration();
  s.more = "subsection model parameters\nsubsection contact detection\n" +
           Scene::entry("contact detection method", search) +
           Scene::entry("frequency", search == "constant" ? "10" : "1") + "end\nend\n";
  std::vector<double> deepest(s.spheres.size(), 0.);
  const std::vector<Sphere> end = run(s, [&](Simulation &simulation) {
    const std::vector<Sphere> now = spheres_of(simulation);
    for (std::size_t k = 0; k < now.size(); ++k)
      deepest[k] = std::max(deepest[k], direction * now[k].x[axis] + radius - half);
  });
  Errors errors;
  for (std::size_t k = 0; k < end.size(); ++k) {
    errors.overlap = std::max(errors.overlap, std::abs(deepest[k] / hertz.overlap() - 1.));
    errors.speed = std::max(errors.speed, std::abs(-direction * end[k].v[axis] / speed - 1.));
    errors.sideways = std::max(
        {errors.sideways, std::abs(end[k].v[(axis + 1) % 3]), std::abs(end[k].v[(axis + 2) % 3])});
  }
  return errors;
}

} // namespace

EUNOE_MPI_TEST()
{
  for (const std::string search : {"dynamic", "constant"})
    for (unsigned int axis = 0; axis < 3; ++axis)
      for (const double direction : {-1., 1.}) {
        const std::string name = search + " search, wall at " +
                                 (direction < 0. ? "lower " : "upper ") + "xyz"[axis] + ": ";
        const Errors errors = rebound(axis, direction, search);
        check_close(name + "overlap", errors.overlap, 0., 2e-4);
        check_close(name + "speed", errors.speed, 0., 2e-4);
        check_close(name + "sideways", errors.sideways, 0., 0.);
      }
}
