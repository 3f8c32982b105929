#ifndef eunoe_solids_half_space_h
#define eunoe_solids_half_space_h

#include <eunoe/solids/shape.h>

#include <limits>

namespace eunoe {

/// An infinite plane that keeps particles on the side to which its normal points.
class HalfSpace : public Shape
{
public:
  /// @param point on the plane
  /// @param normal towards the particles, of any length but zero
  HalfSpace(const Vec3 &point, const Vec3 &normal) : point(point), normal(normal / norm(normal)) {}

  double find_facets(const Vec3 &centre, double reach,
                     std::vector<std::int32_t> &facets) const override
  {
    const double distance = dot(centre - point, normal);
    if (distance >= reach)
      return std::numeric_limits<double>::infinity();
    facets.push_back(0);
    return distance;
  }

  unsigned int find_contacts(const Vec3 &centre, double, double reach, const std::int32_t *,
                             const std::int32_t *, SurfaceContact *contacts) const override
  {
    const double distance = dot(centre - point, normal);
    contacts[0] = {-normal, distance};
    return distance < reach ? 1 : 0;
  }

  Box bounding_box() const override
  {
    constexpr double inf = std::numeric_limits<double>::infinity();
    return {{-inf, -inf, -inf}, {inf, inf, inf}};
  }

private:
  const Vec3 point, normal;
};

} // namespace eunoe

#endif
