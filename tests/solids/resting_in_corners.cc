// Spheres in grooves and corners without friction rest on the forces that balance their weight,
// N = m g / (2 cos a) in a symmetric groove with walls inclined by a and m g / sqrt 3 in the corner
// of a cube that stands on its tip. With friction a groove is the same as two infinite planes.
// Regression: contacts with one solid must not take each other's memory.

#include "surfaces.h"

using namespace test;

namespace {

/// Lets a sphere come to rest and compares the overlaps with the walls whose normals, towards the
/// sphere, are given.
void rest(const std::string &name, const Powder &powder, const Vec3 &start,
          const std::string &surface, const std::vector<Vec3> &walls, double force)
{
  Case test_case(
      box_input(1e-5, 0.1, powder.input() + insertion_input({{start, {}, {}}}) + surface));
  test_case.run();
  const TouchingSphere s = spheres(*test_case)[0];
  check(name + ": one contact a wall", s.normals.size() == walls.size());
  const double weight = powder.mass() * norm(powder.gravity);
  check_close(name + ": at rest", norm(s.velocity), 0., 1e-6);
  check_close(name + ": in balance", norm(s.force) / weight, 0., 1e-3);
  for (const Vec3 &wall : walls) {
    const double overlap = powder.radius() - dot(s.position, wall);
    check_relative(name + ": overlap", overlap, powder.overlap(force), 1e-3);
  }
}

std::vector<TouchingSphere> slide(const Powder &powder, const Start &start,
                                  const std::string &surface)
{
  std::vector<TouchingSphere> track;
  Case test_case(box_input(1e-5, 0.02, powder.input() + insertion_input({start}) + surface));
  test_case.run([&](Simulation &simulation) { track.push_back(spheres(simulation)[0]); });
  return track;
}

/// Compares how a sphere slides and rolls on one surface and between two infinite planes.
void compare(const std::string &name, const Powder &powder, const Start &start,
             const std::string &surface, const Vec3 &first, const Vec3 &second)
{
  const auto one = slide(powder, start, surface);
  const auto two = slide(powder, start, walls_input({{{}, first}, {{}, second}}));
  int in_both = 0;
  double position = 0., spin = 0.;
  for (std::size_t k = 0; k < one.size(); ++k) {
    in_both += one[k].normals.size() == 2 ? 1 : 0;
    position = std::max(position, norm(one[k].position - two[k].position));
    spin = std::max(spin, norm(one[k].spin - two[k].spin));
  }
  check("it touches both sides of the " + name, in_both > 20);
  // Round-off of the coordinates is 1e-12 of the overlap.
  check_close("path in the " + name + " as between two walls", position, 0., 1e-14);
  check_close("spin in the " + name + " as between two walls", spin, 0., 1e-8);
}

} // namespace

EUNOE_MPI_TEST()
{
  const double degree = M_PI / 180.;
  Powder powder;
  powder.friction = 0.;
  powder.restitution = 0.1;
  const double R = powder.radius();
  for (const double angle : {20. * degree, 50. * degree}) {
    write_gmsh(groove(angle, 8), "groove.msh");
    powder.gravity = {0., -9.81, 0.};
    rest("groove", powder, {0., R / std::cos(angle) + 1e-6, 0.1e-3}, gmsh_input("groove.msh"),
         {{std::sin(angle), std::cos(angle), 0.}, {-std::sin(angle), std::cos(angle), 0.}},
         powder.mass() * 9.81 / (2. * std::cos(angle)));
  }
  const double third = 9.81 / std::sqrt(3.);
  powder.gravity = {-third, -third, -third};
  rest("corner", powder, {R + 1e-6, R + 1e-6, R + 1e-6},
       shape_input("box", "0,0,0 : 5e-3,5e-3,5e-3"), {{1., 0., 0.}, {0., 1., 0.}, {0., 0., 1.}},
       powder.mass() * third);

  // Along a flat groove, whose two normals are nearly parallel.
  const double angle = 10. * degree;
  powder.gravity = {-1., -9.81, 0.};
  powder.friction = 0.3;
  powder.rolling_friction = 0.05;
  write_gmsh(groove(angle, 8), "groove.msh");
  compare("groove", powder,
          {{0., R / std::cos(angle) - 2e-7, -1.5e-3}, {0., 0., 0.1}, {0., 90., 5.}},
          gmsh_input("groove.msh"), {std::sin(angle), std::cos(angle), 0.},
          {-std::sin(angle), std::cos(angle), 0.});
  // Over a floor and so fast against a wall that the wall has the larger overlap at once.
  compare("corner", powder, {{2e-3, R - 2e-7, 2e-3}, {-0.4, 0., 0.1}, {0., 0., -300.}},
          shape_input("box", "0,0,-9e-3 : 9e-3,9e-3,9e-3"), {1., 0., 0.}, {0., 1., 0.});
}
