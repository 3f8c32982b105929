#include <eunoe/solids/box_tree.h>
#include <eunoe/solids/crossings.h>

#include <algorithm>
#include <array>

namespace eunoe {
namespace {

Box box_around(const Vec3 *corner)
{
  return Box::around(std::array<Vec3, 3>{{corner[0], corner[1], corner[2]}});
}

/// Whether the segment from @p p to @p q goes through a triangle, and not just to its border.
bool pierces(const Vec3 &p, const Vec3 &q, const Vec3 *corner, const double tolerance, Vec3 &where)
{
  const Vec3 normal = cross(corner[1] - corner[0], corner[2] - corner[0]);
  const double length = norm(normal);
  const double below = dot(p - corner[0], normal) / length,
               above = dot(q - corner[0], normal) / length;
  if (std::min(below, above) > -tolerance || std::max(below, above) < tolerance)
    return false;
  where = p + below / (below - above) * (q - p);
  for (unsigned int c = 0; c < 3; ++c) {
    const Vec3 edge = corner[(c + 1) % 3] - corner[c];
    const double inside = dot(cross(normal, edge), where - corner[c]) / (length * norm(edge));
    if (inside < tolerance)
      return false;
  }
  return true;
}

/// Whether an edge or a median of triangle @p a goes through @p b. Medians, as the edges may all
/// meet @p b at its border, where it has a neighbour.
bool passes_through(const Vec3 *a, const Vec3 *b, const double tolerance, Vec3 &where)
{
  for (unsigned int c = 0; c < 3; ++c) {
    const Vec3 &next = a[(c + 1) % 3], &last = a[(c + 2) % 3];
    if (pierces(a[c], next, b, tolerance, where) ||
        pierces(a[c], 0.5 * (next + last), b, tolerance, where))
      return true;
  }
  return false;
}

} // namespace

bool surfaces_cross(const std::vector<Vec3> &a, const std::vector<Vec3> &b, const double tolerance,
                    Vec3 &where)
{
  std::vector<std::pair<Box, std::int32_t>> boxes;
  for (std::size_t t = 0; t + 2 < b.size(); t += 3)
    boxes.emplace_back(box_around(&b[t]), static_cast<std::int32_t>(t));
  const BoxTree tree(boxes);
  for (std::size_t t = 0; t + 2 < a.size(); t += 3)
    if (tree.any_meeting(box_around(&a[t]), [&](const std::int32_t other) {
          return passes_through(&a[t], &b[other], tolerance, where) ||
                 passes_through(&b[other], &a[t], tolerance, where);
        }))
      return true;
  return false;
}

} // namespace eunoe
