#ifndef eunoe_solids_surface_part_h
#define eunoe_solids_surface_part_h

#include <eunoe/solids/triangulated_surface.h>

namespace eunoe {

/// Some of the triangles of a surface, as a solid of its own. Where parts meet, contacts are those
/// of the whole surface: a contact belongs only to the part on whose triangle it is.
class SurfacePart : public Shape
{
public:
  /// @param number of this part
  /// @param part_of the part to which each triangle of the surface belongs
  SurfacePart(std::shared_ptr<const TriangulatedSurface> whole, int number,
              std::shared_ptr<const std::vector<int>> part_of);

  double find_facets(const Vec3 &centre, double reach,
                     std::vector<std::int32_t> &facets) const override;
  unsigned int find_contacts(const Vec3 &centre, double radius, double reach,
                             const std::int32_t *begin, const std::int32_t *end,
                             SurfaceContact *contacts) const override;
  Box bounding_box() const override { return box; }
  std::vector<Vec3> triangles() const override;

private:
  bool is_mine(std::int32_t facet) const { return (*part_of)[facet] == number; }

  const std::shared_ptr<const TriangulatedSurface> whole;
  const int number;
  const std::shared_ptr<const std::vector<int>> part_of;
  Box box;
};

} // namespace eunoe

#endif
