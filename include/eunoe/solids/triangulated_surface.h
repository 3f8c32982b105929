#ifndef eunoe_solids_triangulated_surface_h
#define eunoe_solids_triangulated_surface_h

#include <eunoe/solids/shape.h>
#include <eunoe/solids/triangle_mesh.h>

#include <array>
#include <memory>
#include <string>

namespace eunoe {

class BoxTree;

/// A surface of triangles, two-sided: a particle is kept on the side where its centre is.
class TriangulatedSurface : public Shape
{
public:
  /// Edges at which the surface turns by less than this count as smooth: where such a surface is
  /// concave, as inside a faceted cylinder, the facets are felt as one curved wall.
  static constexpr double smooth_angle = 15. * M_PI / 180.;

  explicit TriangulatedSurface(TriangleMesh mesh);
  ~TriangulatedSurface() override;

  double find_facets(const Vec3 &centre, double reach,
                     std::vector<std::int32_t> &facets) const override;
  unsigned int find_contacts(const Vec3 &centre, double radius, double reach,
                             const std::int32_t *begin, const std::int32_t *end,
                             SurfaceContact *contacts) const override
  {
    return find_contacts(centre, radius, reach, {begin, end}, contacts, nullptr);
  }
  /// Numbers of facets, as `find_facets` gives them.
  struct Facets
  {
    const std::int32_t *begin, *end;
  };
  /// The same, and tells which facet each contact is on, the nearest one.
  /// @param owners as many as there may be contacts, or null
  unsigned int find_contacts(const Vec3 &centre, double radius, double reach, const Facets &near,
                             SurfaceContact *contacts, std::int32_t *owners) const;
  bool is_plane(const Vec3 &centre, double reach, const std::int32_t *begin,
                const std::int32_t *end, Plane &plane) const override;
  Box bounding_box() const override { return box; }
  std::vector<Vec3> triangles() const override;

private:
  /// Of the smooth angle, with room for round-off.
  static const double smooth_cosine;

  struct Facet
  {
    std::array<Vec3, 3> corner;
    std::array<std::int32_t, 3> vertex;
    Vec3 normal;         ///< unit normal; the same bits in all triangles of a plane
    double offset;       ///< normal . x on the plane; the same bits, too
    std::int32_t plane;  ///< connected coplanar triangles share a number
    std::int32_t smooth; ///< triangles connected by smooth edges share a number
    /// Whether the plane ends at the edge from each corner to the next.
    std::array<bool, 3> is_border;
  };
  struct Touch;
  struct Edges;
  class NearPlaces;

  Edges make_facets(const TriangleMesh &mesh);
  /// Unites facets that are neighbours: `joins(seed, facet, neighbour)` decides whether one belongs
  /// to the seed's group, `enter(seed, neighbour)` takes it in.
  template <typename Joins, typename Enter>
  void unite(std::int32_t Facet::*group, const Edges &edges, const Joins &joins,
             const Enter &enter);
  void find_planes(const Edges &edges, double tolerance);
  void find_smooth_parts(const Edges &edges);
  void find_borders(const Edges &edges);
  void find_flat_vertices(const Edges &edges, std::size_t n_vertices);

  Touch closest(const Vec3 &centre, std::int32_t facet) const;

  std::vector<Facet> facets;
  /// Whether all triangles around a corner lie in one plane and close a full turn.
  std::vector<bool> flat_vertex;
  Box box;
  std::unique_ptr<const BoxTree> tree;
};

} // namespace eunoe

#endif
