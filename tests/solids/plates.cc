// A plate is one surface whatever its triangles: a sphere over it has one contact, with the nearest
// point. Reference: the nearest point of a rectangle by clamping; over the inside a single plane.
// Regression: double contacts on the shared edges of triangles, different bits for different
// meshes.

#include "surfaces.h"

using namespace test;

namespace {

const double R = 1e-4;
const Vec3 corner = {-2e-3, 1e-3, -1e-3};
const Vec3 u = {4e-3, 0., 0.}, v = {0., 0., 2e-3};

/// Nearest point of the plate.
Vec3 nearest(const Vec3 &x)
{
  return {std::clamp(x.x, corner.x, corner.x + u.x), corner.y,
          std::clamp(x.z, corner.z, corner.z + v.z)};
}

/// Spheres over corners and along edges of triangles, exactly and just beside, then anywhere.
std::vector<Vec3> places_over(const TriangleMesh &mesh)
{
  std::vector<Vec3> places;
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> share(0., 1.);
  std::vector<double> heights = {0.};
  for (const double height : {0.999, 0.5, 1e-3, 1e-9, 1e-15})
    heights.insert(heights.end(), {height * R, -height * R});
  std::vector<double> beside = {0.};
  for (double exponent = -14.; exponent < 0.; exponent += 0.5)
    beside.push_back(std::pow(10., exponent) * R);
  for (const auto &triangle : mesh.triangles)
    for (unsigned int e = 0; e < 3; ++e) {
      const Vec3 &a = mesh.vertices[triangle[e]], &b = mesh.vertices[triangle[(e + 1) % 3]];
      for (const double along : {0., 0.5, share(generator)})
        for (const double distance : beside) {
          const double angle = 2. * M_PI * share(generator);
          const double height = heights[places.size() % heights.size()];
          places.push_back(a + along * (b - a) +
                           Vec3{distance * std::cos(angle), height, distance * std::sin(angle)});
        }
    }
  for (int k = 0; k < 20000; ++k)
    places.push_back(corner + (1.2 * share(generator) - 0.1) * u +
                     (1.2 * share(generator) - 0.1) * v +
                     Vec3{0., (2. * share(generator) - 1.) * R, 0.});
  return places;
}

struct Findings
{
  int wrong_number = 0, wrong_side = 0, other_bits = 0, other_than_plane = 0, not_unit = 0;
  double worst_distance = 0., worst_normal = 0.;
  int in_surface = 0, over_rim = 0;
};

/// Whether a place is over the inside of the plate. Round-off decides whether one on the rim still
/// belongs to it.
bool is_over_inside(const Vec3 &x)
{
  const double margin = 1e-8 * R;
  return x.x > corner.x + margin && x.x < corner.x + u.x - margin && x.z > corner.z + margin &&
         x.z < corner.z + v.z - margin;
}

bool same_bits(const SurfaceContact &a, const SurfaceContact &b)
{
  return a.normal == b.normal && a.distance == b.distance;
}

Findings look_at(const TriangleMesh &mesh)
{
  const TriangulatedSurface many(mesh), two(shapes::plane(corner, u, v));
  const HalfSpace above(corner, {0., 1., 0.}), below(corner, {0., -1., 0.});

  Findings f;
  for (const Vec3 &x : places_over(mesh)) {
    const Vec3 offset = nearest(x) - x;
    const double distance = norm(offset);
    const auto found = contacts(many, x, R), plain = contacts(two, x, R);
    if (distance >= R) {
      f.wrong_number += found.empty() && plain.empty() ? 0 : 1;
      continue;
    }
    if (found.size() != 1 || plain.size() != 1) {
      ++f.wrong_number;
      continue;
    }
    const SurfaceContact &contact = found[0];
    f.not_unit += std::abs(norm(contact.normal) - 1.) < 1e-14 ? 0 : 1;
    f.worst_distance = std::max(f.worst_distance, std::abs(contact.distance - distance) / R);
    if (distance == 0.)
      ++f.in_surface;
    else if (distance > 1e-3 * R)
      f.worst_normal = std::max(f.worst_normal, norm(contact.normal - offset / distance));
    f.over_rim += offset.x != 0. || offset.z != 0. ? 1 : 0;
    if (is_over_inside(x) && offset.y != 0.) {
      f.wrong_side += contact.normal.y * offset.y > 0. ? 0 : 1;
      f.other_bits += same_bits(plain[0], contact) ? 0 : 1;
      const auto plane = contacts(offset.y < 0. ? above : below, x, R);
      f.other_than_plane += plane.size() == 1 && same_bits(plane[0], contact) ? 0 : 1;
    }
  }
  return f;
}

void examine_flat(const TriangleMesh &mesh)
{
  const Findings f = look_at(mesh);
  check("there are places in the surface and beyond the rim",
        f.in_surface > 100 && f.over_rim > 100);
  check("one contact with the plate", f.wrong_number == 0,
        std::to_string(f.wrong_number) + " are not");
  check("every normal is a unit vector", f.not_unit == 0, std::to_string(f.not_unit) + " are not");
  check("a sphere stays on its side", f.wrong_side == 0, std::to_string(f.wrong_side) + " do not");
  check("same bits with two triangles", f.other_bits == 0,
        std::to_string(f.other_bits) + " differ");
  check("same bits with an infinite plane", f.other_than_plane == 0,
        std::to_string(f.other_than_plane) + " differ");
  check_close("distance to the nearest point", f.worst_distance, 0., 1e-14);
  // Points whose distances differ by less than round-off cannot be told apart; for a height of 1e-3
  // radii they are up to 5e-7 radii apart, hence the tolerance of the normal.
  check_close("normal to the nearest point", f.worst_normal, 0., 1e-6);
}

/// A tilted plate has one normal, not one for each triangle.
void examine_tilted(const TriangleMesh &mesh)
{
  TriangleMesh tilted = mesh;
  const Rotation turn = Rotation::by({0.3, -0.5, 0.2});
  for (Vec3 &x : tilted.vertices)
    x = turn.apply(x);
  const TriangulatedSurface slope(tilted);
  int other_normal = 0;
  const Vec3 first =
      contacts(slope, turn.apply(corner + 0.5 * u + 0.5 * v + Vec3{0., R / 2., 0.}), R)[0].normal;
  for (double a = 0.1; a < 0.9; a += 0.0123)
    for (double b = 0.1; b < 0.9; b += 0.0234) {
      const Vec3 place = corner + a * u + b * v + Vec3{0., R / 2., 0.};
      other_normal += contacts(slope, turn.apply(place), R)[0].normal == first ? 0 : 1;
    }
  check("one normal all over a tilted plate", other_normal == 0,
        std::to_string(other_normal) + " others");
}

} // namespace

EUNOE_TEST()
{
  const TriangleMesh mesh = uneven_plate(corner, u, v, 10, 6);
  examine_flat(mesh);
  examine_tilted(mesh);
}
