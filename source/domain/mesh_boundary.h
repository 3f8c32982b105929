#ifndef eunoe_source_domain_mesh_boundary_h
#define eunoe_source_domain_mesh_boundary_h

// The boundary of the background mesh, for source files only.

#include <eunoe/core/periodic_box.h>
#include <eunoe/solids/enclosure.h>
#include <eunoe/solids/triangle_mesh.h>

#include <deal.II/distributed/tria.h>

#include <array>
#include <set>
#include <vector>

namespace eunoe {

/// A flat part of the boundary of the coarse mesh with one id.
struct Side
{
  unsigned int id;
  Vec3 point, inward;
};

/// A face of an active cell in the boundary.
struct BoundaryFace
{
  int side;                  ///< of the coarse mesh, from which it descends
  std::vector<Vec3> corners; ///< in a turn, with the hanging ones on its edges
  Vec3 inward;               ///< unit normal
  bool is_flat = false;      ///< its whole side can be an infinite plane
};

/// What bounds the domain, but for periodic ends. All ranks know all of it, in the same order, as
/// walls act wherever particles are.
class MeshBoundary
{
public:
  using Triangulation = dealii::parallel::distributed::Triangulation<3>;

  /// @param triangulation not yet refined
  explicit MeshBoundary(const Triangulation &triangulation);

  const std::vector<Side> &sides() const { return all_sides; }

  /// Looks at the refined mesh; collective.
  /// @param periodic ids that count as no boundary
  /// @param moves whether the mesh moves, so that no infinite plane can stand for a side
  void refine(const Triangulation &triangulation, const std::set<unsigned int> &periodic,
              const PeriodicBox &periods, bool moves);

  /// Whether all sides are flat and the mesh, at rest, lies on one side of each, so that planes
  /// bound it.
  bool is_convex() const { return convex; }
  /// Of a mesh that is not convex, whether a side is a plane nevertheless, like the end of a
  /// cylinder.
  bool is_plane(std::size_t side) const { return planes[side]; }
  /// All faces of a mesh that is not convex.
  const std::vector<BoundaryFace> &faces() const { return all_faces; }

private:
  bool is_alone(std::size_t side) const;
  void find_sides(const Triangulation &triangulation);
  /// By boundary id, so that the order of walls, and with it the last bits of their forces, does
  /// not depend on the cells.
  void order_sides();
  /// Whether the edges of all sides are sharp and the coarse mesh lies on one side of each.
  bool is_convex_before_refinement(const Triangulation &triangulation) const;
  bool has_strayed(const Triangulation &triangulation) const;
  void gather(const Triangulation &triangulation);
  void find_planes(const PeriodicBox &periods);

  double tolerance; ///< (m)
  std::vector<Side> all_sides;
  std::vector<std::array<int, 6>> side_of_face; ///< by index of the coarse cell; -1: none
  std::set<unsigned int> periodic_ids;
  bool convex = true;
  std::vector<bool> planes;
  std::vector<BoundaryFace> all_faces;
};

/// A face as triangles. Of the two diagonals of a face that is not flat, the one further inside is
/// taken, so that the triangles do not leave the cells.
std::vector<std::array<Vec3, 3>> triangles_of(const BoundaryFace &face);

/// Calls @p add for a triangle and for its images beyond periodic ends that particles can meet.
template <typename Add>
void with_images(const std::array<Vec3, 3> &triangle, const PeriodicBox &periods, const Add &add)
{
  std::vector<std::array<Vec3, 3>> images = {triangle};
  for (unsigned int d = 0; d < 3; ++d) {
    if (!periods.is_periodic(d))
      continue;
    const double length = periods.length[d], margin = 0.75 * length;
    for (std::size_t k = images.size(); k-- > 0;)
      for (const double shift : {-length, length}) {
        std::array<Vec3, 3> image = images[k];
        bool is_near = false;
        for (Vec3 &x : image) {
          x[d] += shift;
          is_near = is_near || (x[d] > periods.origin[d] - margin &&
                                x[d] < periods.origin[d] + length + margin);
        }
        if (is_near)
          images.push_back(image);
      }
  }
  for (const auto &image : images)
    add(image);
}

} // namespace eunoe

#endif
