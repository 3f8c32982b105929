// If the facets near a sphere form the inner part of a plane, the plane replaces them until the
// next search. Reference: the contacts with the facets themselves, for spheres anywhere within the
// reach of that search. The border of the plate and its fold must not be replaced.

#include <eunoe/core/random.h>
#include <eunoe/solids/triangulated_surface.h>

#include "../tests.h"

using namespace test;

namespace {

constexpr unsigned int cells = 6;
constexpr double radius = 0.3, skin = 0.1;

/// A plate of triangles, 0 <= x, y <= 6, folded upright at x = 4.
TriangleMesh folded_plate()
{
  TriangleMesh mesh;
  for (unsigned int i = 0; i <= cells; ++i)
    for (unsigned int j = 0; j <= cells; ++j)
      mesh.vertices.push_back({std::min(double(i), 4.), double(j), std::max(double(i) - 4., 0.)});
  for (std::int32_t i = 0; i < std::int32_t(cells); ++i)
    for (std::int32_t j = 0; j < std::int32_t(cells); ++j) {
      const std::int32_t a = i * (cells + 1) + j, b = a + cells + 1;
      mesh.triangles.push_back({{a, b, b + 1}});
      mesh.triangles.push_back({{a, b + 1, a + 1}});
    }
  return mesh;
}

/// Distance to the border of the lower half, without its fold.
double distance_to_border(const Vec3 &x)
{
  const double beyond_x = std::max(0., -x.x), beyond_y = std::max({0., -x.y, x.y - 6.});
  return std::min(norm({x.x, beyond_y, x.z}),
                  norm({beyond_x, std::min(std::abs(x.y), std::abs(x.y - 6.)), x.z}));
}

/// Distance to the half beyond the fold, which stands upright.
double distance_to_upper_half(const Vec3 &x)
{
  return norm({x.x - 4., std::max({0., -x.y, x.y - 6.}), std::min(0., x.z)});
}

/// Uniform numbers between two bounds.
class Numbers
{
public:
  double between(double low, double high)
  {
    return low + (high - low) * uniform(1, Draw::packing, n++);
  }

private:
  std::uint64_t n = 0;
};

} // namespace

EUNOE_TEST()
{
  const TriangulatedSurface plate(folded_plate());
  Numbers numbers;
  unsigned int n_planes = 0, n_contacts = 0, n_other = 0;
  bool same = true, no_border = true, all_inner = true;
  for (unsigned int k = 0; k < 20000; ++k) {
    // At heights at which the lower half is always within reach, never the upper half alone.
    const Vec3 centre = {numbers.between(-0.5, 4.), numbers.between(-0.5, 6.5),
                         numbers.between(-0.39, 0.39)};
    const double near = radius + skin;
    std::vector<std::int32_t> facets;
    plate.find_facets(centre, near, facets);
    if (facets.empty())
      continue;
    const std::int32_t *const begin = facets.data(), *const end = begin + facets.size();
    Plane plane;
    const bool is_plane = plate.is_plane(centre, near, begin, end, plane);
    const double border = distance_to_border(centre), fold = distance_to_upper_half(centre);
    no_border = no_border && !(is_plane && (border < near || fold < near));
    all_inner = all_inner && (is_plane || border < near || fold < near);
    n_other += is_plane ? 0 : 1;
    n_planes += is_plane ? 1 : 0;
    for (unsigned int m = 0; is_plane && m < 5; ++m) {
      Vec3 moved = {numbers.between(-1., 1.), numbers.between(-1., 1.), numbers.between(-1., 1.)};
      moved = centre + skin * numbers.between(0., 1.) / norm(moved) * moved;
      std::array<SurfaceContact, Shape::max_contacts> found;
      const unsigned int n = plate.find_contacts(moved, radius, radius, begin, end, found.data());
      const double height = dot(plane.normal, moved) - plane.offset;
      same = same && n == (std::abs(height) < radius ? 1 : 0);
      if (n == 0)
        continue;
      ++n_contacts;
      same = same && found[0].distance == std::abs(height) &&
             dot(found[0].normal, plane.normal) == (height < 0. ? 1. : -1.);
    }
  }
  check("spheres of both kinds", n_planes > 3000 && n_other > 3000 && n_contacts > 5000);
  check("no plane at the border or the fold", no_border);
  check("a plane elsewhere", all_inner);
  check("the plane gives the contacts of its facets, bit by bit", same);
}
