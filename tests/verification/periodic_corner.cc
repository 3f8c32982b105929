// Several periodic directions at once, on any number of ranks and in any order of declaration: a
// pair that meets over an edge or a corner of the domain moves as one that meets in its middle.
// Regression: other programs had only one pair of periodic boundaries, applied its force twice in
// parallel runs, and overlooked it unless it was declared last.
//
// As in simulation/periodic_pair.cc the domain spans [4, 8] in units of a power of two, so that the
// shift is exact and the bits must be the same.

#include "../spheres.h"

using namespace test;

namespace {

constexpr double unit = 0x1p-9;

/// A boundary condition of the faces across one axis.
std::string boundary(unsigned int number, unsigned int axis, bool periodic, bool upper)
{
  const std::string id = std::to_string(2 * axis), next = std::to_string(2 * axis + 1);
  return "subsection boundary condition " + std::to_string(number) + "\n" +
         (periodic
              ? Scene::entry("type", "periodic") + Scene::entry("periodic id 0", id) +
                    Scene::entry("periodic id 1", next) +
                    Scene::entry("periodic direction", std::to_string(axis))
              : Scene::entry("type", "outlet") + Scene::entry("boundary id", upper ? next : id)) +
         "end\n";
}

/// All particles after the collision.
/// @param n_periodic directions that are periodic, from x on; the others end in outlets
/// @param away whether the pair meets where all periodic directions end
std::vector<std::vector<double>> collide(unsigned int n_periodic, bool away, bool declared_first)
{
  Scene s = dissipative_scene();
  const double r = 0x1p-11;
  s.spheres = {{{-r, -r, -0.75 * r}, {0.4, 0.4, 0.3}, {0., 80., -60.}, 2. * r},
               {{r, r, 0.75 * r}, {-0.4, -0.3, -0.3}, {30., 0., 0.}, 2. * r}};
  for (Sphere &sphere : s.spheres) {
    sphere.x += Vec3{6. * unit, 6. * unit, 6. * unit};
    for (unsigned int d = 0; d < n_periodic && away; ++d) {
      sphere.x[d] += 2. * unit;
      if (sphere.x[d] >= 8. * unit)
        sphere.x[d] -= 4. * unit;
    }
  }
  s.time_step = 1e-6;
  s.time_end = 1.5e-3;
  const std::string lower = Scene::number(4. * unit), upper = Scene::number(8. * unit);
  std::string conditions;
  unsigned int n = 0;
  const auto declare = [&](bool periodic) {
    for (unsigned int d = 0; d < 3; ++d)
      if ((d < n_periodic) == periodic)
        for (int side = 0; side < (periodic ? 1 : 2); ++side)
          conditions += boundary(n++, d, periodic, side == 1);
  };
  declare(declared_first);
  declare(!declared_first);
  s.more = "subsection mesh\n" +
           Scene::entry("grid arguments", "3, 3, 3 : " + lower + "," + lower + "," + lower + " : " +
                                              upper + "," + upper + "," + upper + " : true") +
           "end\nsubsection DEM boundary conditions\n" +
           Scene::entry("number of boundary conditions", std::to_string(n)) + conditions + "end\n";
  Case test_case(s.text());
  test_case.run();
  return particle_table(*test_case);
}

} // namespace

EUNOE_MPI_TEST()
{
  for (unsigned int n_periodic = 1; n_periodic <= 3; ++n_periodic) {
    const std::string name = std::to_string(n_periodic) + " periodic: ";
    const auto middle = collide(n_periodic, false, true);
    check(name + "they collide", middle.size() == 2 && middle[0][c_vx] < 0.2);
    for (const bool first : {true, false}) {
      const auto corner = collide(n_periodic, true, first);
      bool same = corner.size() == 2;
      for (std::size_t k = 0; same && k < 2; ++k)
        for (unsigned int c = c_x; c <= c_wz; ++c) {
          // Positions differ by half a period, and perhaps by a whole one.
          const bool moved = c - c_x < n_periodic;
          const double shift = moved ? std::remainder(corner[k][c] - middle[k][c], 4. * unit) : 0.;
          same = same && (moved ? std::abs(shift) == 2. * unit : corner[k][c] == middle[k][c]);
        }
      check(name + "same motion where they end, declared " + (first ? "first" : "last"), same);
    }
  }
}
