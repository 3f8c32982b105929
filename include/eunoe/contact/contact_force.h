#ifndef eunoe_contact_contact_force_h
#define eunoe_contact_contact_force_h

#include <eunoe/core/vec3.h>

#include <cstdint>

namespace eunoe {

/// What acts in one contact at one moment. SI units.
struct ContactForce
{
  std::int32_t first = -1;  ///< row of a particle
  std::int32_t second = -1; ///< row of the other particle, -1 for a solid
  std::int32_t solid = -1;  ///< number of the solid, -1 for a particle
  Vec3 normal;              ///< unit vector from the first body to the second
  double distance = 0.;     ///< of the centres, or of the centre from the surface (m)
  double overlap = 0.;      ///< negative across a gap (m)
  double normal_force = 0.; ///< repulsion positive (N)
  Vec3 tangential_force;    ///< on the second body (N)
};

} // namespace eunoe

#endif
