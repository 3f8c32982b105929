// How a triangulated surface finds out what its triangles form together.

#include <eunoe/solids/box_tree.h>
#include <eunoe/solids/triangulated_surface.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace eunoe {
namespace {

using Edge = std::pair<std::int32_t, std::int32_t>;

Edge edge_of(const std::array<std::int32_t, 3> &triangle, unsigned int e)
{
  return std::minmax(triangle[e], triangle[(e + 1) % 3]);
}

} // namespace

// An edge of just the smooth angle, as between the 24 facets of a cylinder, is smooth whatever its
// round-off.
const double TriangulatedSurface::smooth_cosine = std::cos(smooth_angle) - 1e-9;

/// The triangles around every edge.
struct TriangulatedSurface::Edges
{
  std::map<Edge, std::vector<std::int32_t>> around;

  const std::vector<std::int32_t> &at(const Facet &facet, unsigned int e) const
  {
    return around.at(edge_of(facet.vertex, e));
  }
};

TriangulatedSurface::TriangulatedSurface(TriangleMesh mesh)
{
  box = Box::around(mesh.vertices);
  const double tolerance = 1e-10 * norm(box.upper - box.lower);
  mesh.merge_vertices(tolerance);
  const Edges edges = make_facets(mesh);
  find_planes(edges, tolerance);
  find_smooth_parts(edges);
  find_borders(edges);
  find_flat_vertices(edges, mesh.vertices.size());

  std::vector<std::pair<Box, std::int32_t>> boxes;
  for (std::size_t t = 0; t < facets.size(); ++t)
    boxes.emplace_back(Box::around(facets[t].corner), static_cast<std::int32_t>(t));
  tree = std::make_unique<const BoxTree>(boxes);
}

TriangulatedSurface::Edges TriangulatedSurface::make_facets(const TriangleMesh &mesh)
{
  Edges edges;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Facet facet;
    facet.vertex = mesh.triangles[t];
    for (unsigned int c = 0; c < 3; ++c) {
      facet.corner[c] = mesh.vertices[facet.vertex[c]];
      edges.around[edge_of(facet.vertex, c)].push_back(static_cast<std::int32_t>(t));
    }
    const Vec3 normal = cross(facet.corner[1] - facet.corner[0], facet.corner[2] - facet.corner[0]);
    facet.normal = normal / norm(normal);
    facet.offset = dot(facet.normal, facet.corner[0]);
    facet.plane = facet.smooth = -1;
    facets.push_back(facet);
  }
  return edges;
}

template <typename Joins, typename Enter>
void TriangulatedSurface::unite(std::int32_t Facet::*group, const Edges &edges, const Joins &joins,
                                const Enter &enter)
{
  for (std::size_t seed = 0; seed < facets.size(); ++seed) {
    if (facets[seed].*group >= 0)
      continue;
    facets[seed].*group = static_cast<std::int32_t>(seed);
    std::vector<std::int32_t> front = {static_cast<std::int32_t>(seed)};
    while (!front.empty()) {
      const std::int32_t here = front.back();
      front.pop_back();
      for (unsigned int e = 0; e < 3; ++e)
        for (const std::int32_t next : edges.at(facets[here], e))
          if (facets[next].*group < 0 && joins(seed, here, next)) {
            facets[next].*group = static_cast<std::int32_t>(seed);
            enter(seed, next);
            front.push_back(next);
          }
    }
  }
}

void TriangulatedSurface::find_planes(const Edges &edges, const double tolerance)
{
  unite(
      &Facet::plane, edges,
      [&](std::size_t seed, std::int32_t, std::int32_t next) {
        return std::all_of(
            facets[next].corner.begin(), facets[next].corner.end(), [&](const Vec3 &x) {
              return std::abs(dot(facets[seed].normal, x) - facets[seed].offset) <= tolerance;
            });
      },
      [&](std::size_t seed, std::int32_t next) {
        facets[next].normal = facets[seed].normal;
        facets[next].offset = facets[seed].offset;
      });
}

void TriangulatedSurface::find_smooth_parts(const Edges &edges)
{
  unite(
      &Facet::smooth, edges,
      [&](std::size_t, std::int32_t here, std::int32_t next) {
        return std::abs(dot(facets[here].normal, facets[next].normal)) >= smooth_cosine;
      },
      [](std::size_t, std::int32_t) {});
}

void TriangulatedSurface::find_borders(const Edges &edges)
{
  for (Facet &facet : facets)
    for (unsigned int e = 0; e < 3; ++e) {
      const std::vector<std::int32_t> &around = edges.at(facet, e);
      facet.is_border[e] = around.size() != 2 || facets[around[0]].plane != facets[around[1]].plane;
    }
}

void TriangulatedSurface::find_flat_vertices(const Edges &edges, const std::size_t n_vertices)
{
  flat_vertex.assign(n_vertices, true);
  std::vector<std::int32_t> plane_of_vertex(n_vertices, -1);
  for (const Facet &facet : facets)
    for (unsigned int c = 0; c < 3; ++c) {
      std::int32_t &plane = plane_of_vertex[facet.vertex[c]];
      if ((plane >= 0 && plane != facet.plane) || edges.at(facet, c).size() != 2 ||
          edges.at(facet, (c + 2) % 3).size() != 2)
        flat_vertex[facet.vertex[c]] = false;
      plane = facet.plane;
    }
}

} // namespace eunoe
