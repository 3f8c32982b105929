// Outside a box, a sphere has one contact, with the nearest point of the box, wherever it is: over
// faces, edges and corners, exactly on the borders of their regions and just beside them; the force
// is the same all around an edge. Reference: the nearest point of a box by clamping.
// Regression: two contacts beside an edge and three beside a corner, at 1e-6 to 1e-5 radii.

#include "surfaces.h"

using namespace test;

namespace {

const double R = 1e-4;
const Vec3 lower = {0., -1e-3, 2e-3}, upper = {1e-3, 0., 3.5e-3};

Vec3 nearest(const Vec3 &x)
{
  return {std::clamp(x.x, lower.x, upper.x), std::clamp(x.y, lower.y, upper.y),
          std::clamp(x.z, lower.z, upper.z)};
}

struct Comparison
{
  int n = 0, wrong_number = 0;
  double worst_distance = 0., worst_normal = 0.;

  void add(const Shape &shape, const Vec3 &x)
  {
    ++n;
    const Vec3 offset = nearest(x) - x;
    const double distance = norm(offset);
    const auto found = contacts(shape, x, R);
    if (found.size() != (distance < R ? 1 : 0))
      ++wrong_number;
    else if (found.size() == 1) {
      worst_distance = std::max(worst_distance, std::abs(found[0].distance - distance) / R);
      worst_normal = std::max(worst_normal, norm(found[0].normal - offset / distance));
    }
  }

  void report(const std::string &where) const
  {
    check("one contact " + where, wrong_number == 0,
          std::to_string(wrong_number) + " of " + std::to_string(n) + " are not");
    check_close("distance " + where, worst_distance, 0., 1e-12);
    // The spheres are at least 0.1 radii away; round-off blurs the border of two regions by the
    // square root of its size.
    check_close("normal " + where, worst_normal, 0., 1e-6);
  }
};

/// The box with each face cut into many triangles, whose corners coincide along the edges.
TriangleMesh fine_box()
{
  const Vec3 d = upper - lower;
  TriangleMesh mesh;
  const auto add_face = [&](const Vec3 &corner, const Vec3 &u, const Vec3 &v) {
    constexpr int n = 4;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const auto at = [&](int k, int l) { return corner + (k / 4.) * u + (l / 4.) * v; };
        mesh.add_quad(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
      }
  };
  const Vec3 x = {d.x, 0., 0.}, y = {0., d.y, 0.}, z = {0., 0., d.z};
  for (const Vec3 &side : {Vec3(), x})
    add_face(lower + side, y, z);
  for (const Vec3 &side : {Vec3(), y})
    add_face(lower + side, z, x);
  for (const Vec3 &side : {Vec3(), z})
    add_face(lower + side, x, y);
  return mesh;
}

void examine(const std::string &name, const TriangleMesh &mesh)
{
  const TriangulatedSurface box(mesh);
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> share(0., 1.);

  Comparison beside;
  for (double exponent = -14.; exponent < -0.5; exponent += 0.05)
    for (const double height : {0.999, 0.9, 0.5, 0.1}) {
      const double s = std::pow(10., exponent) * R, h = height * R;
      const double along = lower.z + share(generator) * (upper.z - lower.z);
      for (const double side : {s, 0., -s}) {
        beside.add(box, {upper.x - side, upper.y + h, along});
        beside.add(box, {upper.x - side, upper.y + h, upper.z - 0.7 * s});
        beside.add(box, {upper.x - side, upper.y + h, upper.z + 0.3 * s});
        beside.add(box, {upper.x + 0.6 * h, upper.y + 0.7 * h, upper.z - side});
      }
    }
  beside.report("beside edges and corners of " + name);

  Comparison anywhere;
  while (anywhere.n < 20000) {
    Vec3 x;
    for (unsigned int d = 0; d < 3; ++d)
      x[d] = lower[d] - 1.1 * R + share(generator) * (upper[d] - lower[d] + 2.2 * R);
    if (norm(nearest(x) - x) > 0.1 * R)
      anywhere.add(box, x);
  }
  anywhere.report("anywhere around " + name);

  // Around an edge at a constant distance, and from there around a corner.
  const double distance = 0.99 * R;
  constexpr int n = 100000;
  double largest_turn = 0.;
  int wrong = 0;
  Vec3 last = {0., -1., 0.};
  for (int k = 0; k <= n; ++k) {
    const double angle = M_PI * k / n;
    const Vec3 direction = k <= n / 2 ? Vec3{std::sin(angle), std::cos(angle), 0.}
                                      : Vec3{std::sin(angle), 0., -std::cos(angle)};
    const Vec3 base = k <= n / 2 ? Vec3{upper.x, upper.y, 2.3e-3} : upper;
    const auto found = contacts(box, base + distance * direction, R);
    wrong += found.size() == 1 && std::abs(found[0].distance - distance) < 1e-12 * R ? 0 : 1;
    largest_turn = std::max(largest_turn, norm(found[0].normal - last));
    last = found[0].normal;
  }
  check("same overlap all around " + name, wrong == 0, std::to_string(wrong) + " differ");
  check_close("the normal turns steadily around " + name, largest_turn, M_PI / n, 1e-6);
}

} // namespace

EUNOE_TEST()
{
  examine("the box", shapes::box(lower, upper));
  examine("a box of many triangles", fine_box());
}
