#ifndef eunoe_solids_infinite_plane_h
#define eunoe_solids_infinite_plane_h

#include <eunoe/solids/shape.h>

#include <cmath>
#include <limits>

namespace eunoe {

/// An infinite plane with two sides: it keeps a particle on the side on which its centre was at the
/// search for contacts.
class InfinitePlane : public Shape
{
public:
  /// @param point on the plane
  /// @param normal of any length but zero
  InfinitePlane(const Vec3 &point, const Vec3 &normal) : point(point), normal(normal / norm(normal))
  {
  }

  /// Facet 0 is the side to which the normal points, facet 1 the other one.
  double find_facets(const Vec3 &centre, double reach,
                     std::vector<std::int32_t> &facets) const override
  {
    const double height = height_of(centre);
    if (std::abs(height) >= reach)
      return std::numeric_limits<double>::infinity();
    facets.push_back(height >= 0. ? 0 : 1);
    return std::abs(height);
  }

  unsigned int find_contacts(const Vec3 &centre, double, double reach, const std::int32_t *begin,
                             const std::int32_t *end, SurfaceContact *contacts) const override
  {
    if (begin == end)
      return 0;
    // The side is the one of the search, lest a soft particle that is pressed beyond the plane
    // comes out behind it.
    const double side = *begin == 0 ? 1. : -1.;
    contacts[0] = {-side * normal, side * height_of(centre)};
    return contacts[0].distance < reach ? 1 : 0;
  }

  Box bounding_box() const override
  {
    constexpr double inf = std::numeric_limits<double>::infinity();
    return {{-inf, -inf, -inf}, {inf, inf, inf}};
  }

private:
  double height_of(const Vec3 &centre) const { return dot(centre - point, normal); }

  const Vec3 point, normal;
};

} // namespace eunoe

#endif
