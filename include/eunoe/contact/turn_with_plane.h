#ifndef eunoe_contact_turn_with_plane_h
#define eunoe_contact_turn_with_plane_h

#include <eunoe/core/simd.h>

namespace eunoe {

/// Turns a remembered in-plane vector with the contact plane: projects it onto the plane of the
/// present normal and restores its length. A null vector stays null.
///
/// The root of the ratio q of the squared lengths is taken as (3 q + 1) / (q + 3), one step of
/// Halley's method from 1. What that changes is (q - 1)^3 / 32, less than rounding for turns by up
/// to 0.3 degrees in a step, and 2e-6 of the length for 10 degrees.
EUNOE_ALWAYS_INLINE Vec3 turn_with_plane(const double hx, const double hy, const double hz,
                                         const double nx, const double ny, const double nz)
{
  const double out_of_plane = hx * nx + hy * ny + hz * nz;
  const double px = hx - out_of_plane * nx;
  const double py = hy - out_of_plane * ny;
  const double pz = hz - out_of_plane * nz;
  const double length2 = hx * hx + hy * hy + hz * hz;
  const double in_plane2 = px * px + py * py + pz * pz;
  const double below = length2 + 3. * in_plane2;
  const double stretch = (3. * length2 + in_plane2) / (below > 0. ? below : 1.);
  return {px * stretch, py * stretch, pz * stretch};
}

} // namespace eunoe

#endif
