#include <eunoe/solids/shape.h>
#include <eunoe/solids/triangle_mesh.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace eunoe {

void TriangleMesh::add_quad(const Vec3 &a, const Vec3 &b, const Vec3 &c, const Vec3 &d)
{
  const auto first = static_cast<std::int32_t>(vertices.size());
  vertices.insert(vertices.end(), {a, b, c, d});
  triangles.push_back({first, first + 1, first + 2});
  triangles.push_back({first, first + 2, first + 3});
}

void TriangleMesh::append(const TriangleMesh &other)
{
  const auto first = static_cast<std::int32_t>(vertices.size());
  vertices.insert(vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto &t : other.triangles)
    triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

void TriangleMesh::merge_vertices(const double tolerance)
{
  std::vector<std::int32_t> order(vertices.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    return vertices[a].x != vertices[b].x ? vertices[a].x < vertices[b].x : a < b;
  });
  std::vector<std::int32_t> target(vertices.size(), -1);
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (target[order[k]] >= 0)
      continue;
    target[order[k]] = order[k];
    for (std::size_t l = k + 1;
         l < order.size() && vertices[order[l]].x - vertices[order[k]].x <= tolerance; ++l)
      if (target[order[l]] < 0 && norm(vertices[order[l]] - vertices[order[k]]) <= tolerance)
        target[order[l]] = order[k];
  }
  for (auto &triangle : triangles)
    for (std::int32_t &vertex : triangle)
      vertex = target[vertex];
}

std::string TriangleMesh::defect() const
{
  if (triangles.empty())
    return "it has no triangles";
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (const std::int32_t vertex : triangles[t]) {
      if (vertex < 0 || vertex >= static_cast<std::int32_t>(vertices.size()))
        return "triangle " + std::to_string(t) + " names a corner that does not exist";
      if (!std::isfinite(norm_square(vertices[vertex])))
        return "triangle " + std::to_string(t) + " has a corner that is not a number";
    }
  const Box box = Box::around(vertices);
  const double extent = norm(box.upper - box.lower);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Vec3 &a = vertices[triangles[t][0]], &b = vertices[triangles[t][1]],
               &c = vertices[triangles[t][2]];
    const double area = 0.5 * norm(cross(b - a, c - a));
    const double longest = std::max({norm(b - a), norm(c - b), norm(a - c)});
    if (area <= 1e-12 * longest * longest || longest <= 1e-12 * extent)
      return "triangle " + std::to_string(t) + " is degenerate: its corners lie on one line";
  }
  return "";
}

} // namespace eunoe
