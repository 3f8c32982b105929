// In a concave corner a sphere touches every wall once, two in an edge and three in a corner, also
// where the walls are many triangles. Reference: geometry of two or three planes.

#include "surfaces.h"

using namespace test;

namespace {

/// Spheres along a groove, in its middle and slightly beside it, that touch both walls.
void examine_groove(double angle)
{
  const double R = 1e-3, d = 0.97 * R;
  const TriangulatedSurface shape(groove(angle, 8));
  int wrong = 0, n = 0;
  double worst = 0.;
  for (double z = -2e-3; z < 2e-3; z += 1.37e-5)
    for (const double shift : {0., 1e-12, -1e-9, 1e-6, -1e-5, 1e-3, -2e-2}) {
      ++n;
      const Vec3 x = {shift * R, d / std::cos(angle), z};
      auto found = contacts(shape, x, R);
      if (found.size() != 2) {
        ++wrong;
        continue;
      }
      std::sort(found.begin(), found.end(), [](const SurfaceContact &a, const SurfaceContact &b) {
        return a.normal.x < b.normal.x;
      });
      for (int side = 0; side < 2; ++side) {
        const Vec3 normal = {(side == 0 ? -1. : 1.) * std::sin(angle), -std::cos(angle), 0.};
        worst = std::max({worst, norm(found[side].normal - normal),
                          std::abs(found[side].distance + dot(normal, x)) / R});
      }
    }
  check("two contacts everywhere in the groove", wrong == 0,
        std::to_string(wrong) + " of " + std::to_string(n) + " have another number");
  check_close("normals and distances in the groove", worst, 0., 1e-12);
}

void examine_corner()
{
  const double R = 1e-3;
  const TriangulatedSurface box(shapes::box({}, {5e-3, 5e-3, 5e-3}));
  const Vec3 distances = {0.9 * R, 0.95 * R, 0.97 * R};
  std::array<int, 3> found = {{0, 0, 0}};
  for (const SurfaceContact &contact : contacts(box, distances, R))
    for (unsigned int d = 0; d < 3; ++d)
      found[d] += std::abs(contact.normal[d] + 1.) < 1e-15 &&
                          std::abs(contact.distance - distances[d]) < 1e-15
                      ? 1
                      : 0;
  check("three contacts in a corner",
        contacts(box, distances, R).size() == 3 && found == std::array<int, 3>({{1, 1, 1}}));
}

} // namespace

EUNOE_TEST()
{
  const double degree = M_PI / 180.;
  for (const double angle : {30. * degree, 45. * degree, 60. * degree})
    examine_groove(angle);
  examine_corner();
}
