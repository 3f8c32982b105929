#include <eunoe/solids/box_tree.h>
#include <eunoe/solids/enclosure.h>

#include <limits>
#include <utility>

namespace eunoe {
namespace {

/// A point seen along an axis.
struct Flat
{
  double u, v;
};

/// Whether the ray from a point in direction u crosses an edge. Both triangles at an edge get the
/// same answer to the last bit, so no ray slips between them or meets both.
bool crosses(const Flat &x, Flat a, Flat b)
{
  if ((a.v > x.v) == (b.v > x.v))
    return false;
  if (std::pair(a.v, a.u) > std::pair(b.v, b.u))
    std::swap(a, b);
  return x.u < a.u + (x.v - a.v) / (b.v - a.v) * (b.u - a.u);
}

} // namespace

Enclosure::Enclosure(std::vector<Triangle> triangles_, const PeriodicBox &periods)
    : triangles(std::move(triangles_)), periods(periods), up(0)
{
  while (up < 2 && periods.is_periodic(up))
    ++up;
  std::vector<std::pair<Box, std::int32_t>> boxes;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    boxes.emplace_back(Box::around(triangles[t].corner), static_cast<std::int32_t>(t));
  tree = std::make_unique<const BoxTree>(boxes);
}

Enclosure::~Enclosure() = default;

/// Whether the number of triangles above is odd (Shimrat, Communications of the ACM 5, 1962, 434).
bool Enclosure::contains(const Vec3 &position) const
{
  const Vec3 x = periods.wrap(position);
  const unsigned int u = (up + 1) % 3, v = (up + 2) % 3;
  Vec3 top = x;
  top[up] = std::numeric_limits<double>::max();
  bool inside = false;
  tree->for_each_meeting({x, top}, [&](const std::int32_t number) {
    const std::array<Vec3, 3> &corner = triangles[number].corner;
    const auto flat = [&](const Vec3 &p) { return Flat{p[u], p[v]}; };
    bool covers = false;
    for (unsigned int e = 0; e < 3; ++e)
      covers = covers != crosses(flat(x), flat(corner[e]), flat(corner[(e + 1) % 3]));
    if (!covers)
      return;
    const Vec3 normal = cross(corner[1] - corner[0], corner[2] - corner[0]);
    const Vec3 from = x - corner[0];
    const double height = -(normal[u] * from[u] + normal[v] * from[v]) / normal[up];
    if (height > from[up])
      inside = !inside;
  });
  return inside;
}

int Enclosure::exit(const Vec3 &from, const Vec3 &to) const
{
  // A path through the common edge of two triangles must not slip between them.
  constexpr double margin = 1e-6;
  const Vec3 way = to - from;
  const std::array<Vec3, 2> ends = {from, to};
  double last = -1.;
  int tag = -1;
  tree->for_each_meeting(Box::around(ends), [&](const std::int32_t number) {
    const auto &[c, own_tag] = triangles[number];
    const Vec3 edge = c[1] - c[0], other = c[2] - c[0];
    // Moeller and Trumbore, Journal of Graphics Tools 2 (1), 1997, 21.
    const Vec3 p = cross(way, other);
    const double volume = dot(edge, p);
    if (volume == 0.)
      return;
    const Vec3 s = from - c[0], q = cross(s, edge);
    const double a = dot(s, p) / volume, b = dot(way, q) / volume, share = dot(other, q) / volume;
    const bool meets =
        a >= -margin && b >= -margin && a + b <= 1. + margin && share >= 0. && share <= 1.;
    // If triangles are met at the same place, the largest tag counts, whatever the order in the
    // tree.
    if (meets && (share > last || (share == last && own_tag > tag))) {
      last = share;
      tag = own_tag;
    }
  });
  return tag;
}

} // namespace eunoe
