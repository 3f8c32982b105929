#ifndef eunoe_solids_shape_h
#define eunoe_solids_shape_h

#include <eunoe/core/vec3.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace eunoe {

/// A place where a sphere meets a surface.
struct SurfaceContact
{
  Vec3 normal;     ///< unit vector from the sphere's centre to the surface
  double distance; ///< from the centre to the surface; negative beyond a one-sided surface (m)
};

/// The points x with normal . x = offset.
struct Plane
{
  Vec3 normal; ///< of length one
  double offset;
};

/// Axis-aligned box.
struct Box
{
  Vec3 lower, upper;

  bool contains(const Vec3 &x, double margin) const
  {
    return x.x >= lower.x - margin && x.x <= upper.x + margin && x.y >= lower.y - margin &&
           x.y <= upper.y + margin && x.z >= lower.z - margin && x.z <= upper.z + margin;
  }

  /// The smallest box around points, of which there must be one at least.
  template <class Points>
  static Box around(const Points &points)
  {
    Box box{points[0], points[0]};
    for (const Vec3 &p : points) {
      box.lower = {std::min(box.lower.x, p.x), std::min(box.lower.y, p.y),
                   std::min(box.lower.z, p.z)};
      box.upper = {std::max(box.upper.x, p.x), std::max(box.upper.y, p.y),
                   std::max(box.upper.z, p.z)};
    }
    return box;
  }
};

/// The geometry of a solid in its own frame, which moves with it; so nothing here ever changes and
/// what is searched once stays true however the solid moves.
class Shape
{
public:
  /// Most contacts that one sphere can have with one shape.
  static constexpr unsigned int max_contacts = 6;

  virtual ~Shape() = default;

  /// Appends the numbers of all facets closer than @p reach to @p centre, ascending.
  /// @return least distance to one of them (m), infinite if there is none
  virtual double find_facets(const Vec3 &centre, double reach,
                             std::vector<std::int32_t> &facets) const = 0;

  /// The contacts, at most `max_contacts`, of a sphere with the facets [begin, end), which must
  /// hold all those closer than @p reach.
  ///
  /// There is one contact for every local minimum of the distance to the surface. A sphere over
  /// the shared edge of coplanar triangles has one, in a concave corner two or three.
  /// @param radius of the sphere (m), the scale of the tolerances
  /// @return number of contacts written
  virtual unsigned int find_contacts(const Vec3 &centre, double radius, double reach,
                                     const std::int32_t *begin, const std::int32_t *end,
                                     SurfaceContact *contacts) const = 0;

  /// Whether the facets [begin, end), all those closer than @p reach to @p centre, are the inner
  /// part of one plane, so that a sphere that stays within that reach of the centre finds what the
  /// plane gives: a contact at its distance, on either side.
  virtual bool is_plane(const Vec3 & /*centre*/, double /*reach*/, const std::int32_t * /*begin*/,
                        const std::int32_t * /*end*/, Plane & /*plane*/) const
  {
    return false;
  }

  /// What encloses the shape; may be infinite.
  virtual Box bounding_box() const = 0;

  /// Triangles for drawing: three corners each.
  virtual std::vector<Vec3> triangles() const { return {}; }
};

} // namespace eunoe

#endif
