// Surfaces that pass through each other are distinguished from those that only touch.

#include <eunoe/solids/crossings.h>

#include "surfaces.h"

using namespace test;

namespace {

std::vector<Vec3> corners(const TriangleMesh &mesh, const Vec3 &shift = {})
{
  std::vector<Vec3> all;
  for (const auto &triangle : mesh.triangles)
    for (const std::int32_t v : triangle)
      all.push_back(mesh.vertices[v] + shift);
  return all;
}

void expect(const std::string &name, const std::vector<Vec3> &a, const std::vector<Vec3> &b,
            bool crossing)
{
  Vec3 where;
  const bool found = surfaces_cross(a, b, 1e-9, where);
  check(name, found == crossing && surfaces_cross(b, a, 1e-9, where) == crossing);
}

} // namespace

EUNOE_TEST()
{
  const std::vector<Vec3> cube = corners(shapes::box({0., 0., 0.}, {1., 1., 1.}));
  const auto moved = [](const Vec3 &shift) {
    return corners(shapes::box({0., 0., 0.}, {1., 1., 1.}), shift);
  };
  const std::vector<Vec3> plate =
      corners(shapes::plane({-1., 0.5, -1.}, {3., 0., 0.}, {0., 0., 3.}));
  expect("cubes that share a corner region", cube, moved({0.3, 0.4, 0.5}), true);
  expect("a cube shifted along its diagonal", cube, moved({0.5, 0.5, 0.5}), true);
  expect("cubes face to face", cube, moved({1., 0., 0.}), false);
  expect("cubes with a common edge", cube, moved({1., 1., 0.}), false);
  expect("cubes apart", cube, moved({1.1, 0., 0.}), false);
  expect("a small cube inside a large one", cube,
         corners(shapes::box({0.2, 0.2, 0.2}, {0.4, 0.4, 0.4})), false);
  expect("a plate through a cube", plate, cube, true);
  expect("a plate through a cube, diagonal over diagonal",
         corners(shapes::plane({0., 0.5, 0.}, {1., 0., 0.}, {0., 0., 1.})), cube, false);
  expect("a plate on a cube", corners(shapes::plane({-1., 1., -1.}, {3., 0., 0.}, {0., 0., 3.})),
         cube, false);
  expect("a plate a nanometre inside",
         corners(shapes::plane({-1., 1. - 1e-10, -1.}, {3., 0., 0.}, {0., 0., 3.})), cube, false);
  expect("a bar over a plate", corners(shapes::half_round_bar({0., 0.6, 0.}, 1., 0.5, 1., 20)),
         plate, false);
  expect("a bar in a plate", corners(shapes::half_round_bar({0., 0.4, 0.}, 1., 0.5, 1., 20)), plate,
         true);
}
