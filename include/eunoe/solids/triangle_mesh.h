#ifndef eunoe_solids_triangle_mesh_h
#define eunoe_solids_triangle_mesh_h

#include <eunoe/core/vec3.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace eunoe {

/// Corners and triangles as they are read or made, not yet checked.
struct TriangleMesh
{
  std::vector<Vec3> vertices;
  std::vector<std::array<std::int32_t, 3>> triangles;

  /// Appends the quadrilateral a-b-c-d as two triangles.
  void add_quad(const Vec3 &a, const Vec3 &b, const Vec3 &c, const Vec3 &d);

  /// Appends another mesh.
  void append(const TriangleMesh &other);

  /// Unites corners that lie closer than @p tolerance (m), as contacts need to know which
  /// triangles are neighbours.
  void merge_vertices(double tolerance);

  /// A sentence that says why this cannot be a surface, empty if it can.
  std::string defect() const;
};

} // namespace eunoe

#endif
