#ifndef eunoe_core_periodic_box_h
#define eunoe_core_periodic_box_h

#include <eunoe/core/simd.h>

#include <limits>

namespace eunoe {

/// The shortest image of one component of a difference, for vector code.
/// @param half of the length, infinite without a period
EUNOE_ALWAYS_INLINE double shortest_image(double d, double half, double length)
{
  d = d > half ? d - length : d;
  return d < -half ? d + length : d;
}

/// The lengths after which space repeats. Positions stay as they are; the shift is applied to
/// differences, so a periodic image gives the same bits as its original.
struct PeriodicBox
{
  /// Period of each direction (m), 0 where there is none, and the coordinate at which it starts.
  Vec3 length, origin;

  bool is_periodic(unsigned int d) const { return length[d] > 0.; }

  /// Half the period, infinite where there is none.
  Vec3 half() const
  {
    const auto half_of = [](double l) {
      return l > 0. ? 0.5 * l : std::numeric_limits<double>::infinity();
    };
    return {half_of(length.x), half_of(length.y), half_of(length.z)};
  }

  /// The shortest of all images of a difference of two positions within one period.
  Vec3 shortest(Vec3 d) const
  {
    const Vec3 h = half();
    for (unsigned int c = 0; c < 3; ++c)
      d[c] = shortest_image(d[c], h[c], length[c]);
    return d;
  }

  /// The image of a position that lies in [origin, origin + length).
  Vec3 wrap(Vec3 x) const
  {
    for (unsigned int c = 0; c < 3; ++c)
      if (is_periodic(c)) {
        x[c] -= length[c] * std::floor((x[c] - origin[c]) / length[c]);
        if (x[c] >= origin[c] + length[c])
          x[c] = origin[c];
      }
    return x;
  }
};

} // namespace eunoe

#endif
