#ifndef eunoe_contact_contact_force_h
#define eunoe_contact_contact_force_h

#include <eunoe/core/vec3.h>

#include <cstdint>
#include <functional>

namespace eunoe {

/// What acts in one contact at one moment. SI units.
struct ContactForce
{
  std::int32_t first = -1;  ///< row of a particle
  std::int32_t second = -1; ///< row of the other particle, -1 for a solid
  std::int32_t solid = -1;  ///< number of the solid, -1 for a particle
  Vec3 normal;              ///< unit vector from the first body to the second
  double distance = 0.;     ///< of the centres, or of the centre from the surface (m)
  double overlap = 0.;      ///< negative if the bodies do not touch (m)
  double normal_force = 0.; ///< repulsion positive (N)
  Vec3 tangential_force;    ///< on the second body (N)
  Vec3 rolling_torque;      ///< resistance against rolling, on the first body (N m)

  /// On the second body (N); the first feels the opposite.
  Vec3 force() const { return normal_force * normal + tangential_force; }
  /// On the first body, a sphere of @p radius (m), about its centre (N m).
  Vec3 torque_on_first(double radius) const
  {
    return rolling_torque - radius * cross(normal, tangential_force);
  }
  /// Likewise on the second body.
  Vec3 torque_on_second(double radius) const
  {
    return -rolling_torque - radius * cross(normal, tangential_force);
  }
};

/// Takes in one contact after another.
using ContactForceSink = std::function<void(const ContactForce &)>;

} // namespace eunoe

#endif
