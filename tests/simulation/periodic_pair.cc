// A pair that collides across a periodic face of the domain moves as one that collides in its
// middle.
//
// The domain spans [4, 8] in units of a power of two, where all coordinates are multiples of the
// same smallest number; so the shift between both places is exact and the bits must be the same.

#include "../spheres.h"

using namespace test;

namespace {

constexpr double unit = 0x1p-9;

/// @param spread initial distance of the spheres from where they meet, over their radius
Scene collision(double shift, unsigned int axis, double spread = 1.5)
{
  Scene s = dissipative_scene();
  const double r = 0x1p-11;
  s.spheres = {{{-spread * r, 0.25 * r, 0.}, {0.5, 0., 0.1}, {0., 80., -60.}, 2. * r},
               {{spread * r, -0.25 * r, 0.125 * r}, {-0.5, 0.1, 0.}, {30., 0., 0.}, 2. * r}};
  for (Sphere &sphere : s.spheres) {
    // The direction in which they meet is that of the period.
    for (Vec3 *v : {&sphere.x, &sphere.v, &sphere.w})
      *v = axis == 0 ? *v : axis == 1 ? Vec3{v->z, v->x, v->y} : Vec3{v->y, v->z, v->x};
    sphere.x += Vec3{6. * unit, 6. * unit, 6. * unit};
    sphere.x[axis] += shift;
    if (sphere.x[axis] >= 8. * unit)
      sphere.x[axis] -= 4. * unit;
  }
  s.time_step = 1e-6;
  s.time_end = 2e-3;
  const std::string lower = Scene::number(4. * unit), upper = Scene::number(8. * unit);
  s.more = "subsection mesh\n" +
           Scene::entry("grid arguments", "3, 3, 3 : " + lower + "," + lower + "," + lower + " : " +
                                              upper + "," + upper + "," + upper + " : true") +
           "end\nsubsection DEM boundary conditions\n" +
           Scene::entry("number of boundary conditions", "1") +
           "subsection boundary condition 0\n" + Scene::entry("type", "periodic") +
           Scene::entry("periodic id 0", std::to_string(2 * axis)) +
           Scene::entry("periodic id 1", std::to_string(2 * axis + 1)) +
           Scene::entry("periodic direction", std::to_string(axis)) + "end\nend\n";
  return s;
}

/// Length of the difference of two positions, less whole periods.
double distance(Vec3 d, unsigned int axis)
{
  d[axis] = std::remainder(d[axis], 4. * unit);
  return norm(d);
}

} // namespace

EUNOE_MPI_TEST()
{
  for (unsigned int axis = 0; axis < 3; ++axis) {
    const std::string name = "period along axis " + std::to_string(axis) + ": ";
    const std::vector<Sphere> middle = run(collision(0., axis));
    const double approach = 0.5;
    check(name + "they collide",
          std::abs(middle[0].v[axis] - approach) > 0.5 * approach && norm(middle[1].w) > 50.);
    // Either sphere can be the first one of the pair, on either side of the face.
    for (const bool swapped : {false, true}) {
      Scene scene = collision(2. * unit, axis);
      if (swapped)
        std::swap(scene.spheres[0], scene.spheres[1]);
      std::vector<Sphere> face = run(scene);
      if (swapped)
        std::swap(face[0], face[1]);
      for (std::size_t k = 0; k < 2; ++k) {
        Vec3 shift;
        shift[axis] = k == 0 ? 2. * unit : -2. * unit;
        check(name + "same motion of sphere " + std::to_string(k) + (swapped ? ", swapped" : ""),
              face[k].x == middle[k].x + shift && face[k].v == middle[k].v &&
                  face[k].w == middle[k].w);
      }
    }

    // A centre that passes the face is wrapped at the next search, and the memory of the contact
    // must be kept. Beyond the face coordinates are rounded differently.
    for (const std::string search : {"constant", "dynamic"}) {
      Scene crossing = collision(2. * unit, axis, 0.97), straight = collision(0., axis, 0.97);
      for (Scene *s : {&crossing, &straight}) {
        s->spheres[0].v[axis] += 10.;
        s->spheres[1].v[axis] += 10.;
        s->time_end = 2e-4;
        s->more += "subsection model parameters\nsubsection contact detection\n" +
                   Scene::entry("contact detection method", search) + "end\nend\n";
      }
      const std::vector<Sphere> there = run(straight);
      double deepest = 0.;
      const std::vector<Sphere> here = run(crossing, [&](Simulation &simulation) {
        const std::vector<Sphere> now = spheres_of(simulation);
        if (now[0].x[axis] < 6. * unit || now[0].x[axis] > 8. * unit)
          deepest = std::max(deepest, now[0].diameter - distance(now[0].x - now[1].x, axis));
      });
      check(name + search + " search, in contact across the face", deepest > 1e-7);
      Vec3 shift;
      shift[axis] = 2. * unit;
      double worst = 0.;
      for (std::size_t k = 0; k < 2; ++k)
        worst = std::max({worst, distance(here[k].x - there[k].x - shift, axis) / unit,
                          norm(here[k].v - there[k].v), norm(here[k].w - there[k].w) / 100.});
      check_close(name + search + " search, same motion across the face", worst, 0., 1e-11);
    }
  }
}
