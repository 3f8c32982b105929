#ifndef eunoe_solids_motion_h
#define eunoe_solids_motion_h

#include <eunoe/core/vec3.h>

#include <array>

namespace eunoe {

/// A turn in space: the columns of a rotation matrix.
struct Rotation
{
  Vec3 x = {1., 0., 0.}, y = {0., 1., 0.}, z = {0., 0., 1.};

  Vec3 apply(const Vec3 &v) const { return v.x * x + v.y * y + v.z * z; }
  Vec3 undo(const Vec3 &v) const { return {dot(x, v), dot(y, v), dot(z, v)}; }

  /// The turn by |angle| radians about the direction of @p angle (Rodrigues).
  static Rotation by(const Vec3 &angle);

  /// This turn, followed by @p next.
  Rotation then(const Rotation &next) const
  {
    return {next.apply(x), next.apply(y), next.apply(z)};
  }
};

/// Where a solid is and how it moves at one instant.
struct RigidState
{
  Vec3 centre;           ///< where the origin of the solid's own frame is (m)
  Rotation rotation;     ///< of the solid's frame against space
  Vec3 velocity;         ///< of the centre (m/s)
  Vec3 angular_velocity; ///< about the centre (rad/s)

  Vec3 velocity_at(const Vec3 &x) const { return velocity + cross(angular_velocity, x - centre); }
};

/// Prescribed motion of a solid: a pure function of time, so that a restart needs no state.
class Motion
{
public:
  virtual ~Motion() = default;

  /// @param time (s), not negative
  virtual RigidState at(double time) const = 0;

  /// False for a solid that never turns, whose frame is then only shifted.
  virtual bool rotates() const { return false; }

  /// True where the surface slides along itself while the solid stands still, so that it has no
  /// velocity along its normal.
  virtual bool slides_in_place() const { return false; }
};

/// A solid at rest, whose surface may still slide or turn in place like a conveyor or a drum.
class AtRest : public Motion
{
public:
  explicit AtRest(const Vec3 &centre = {}, const Vec3 &surface_velocity = {},
                  const Vec3 &surface_spin = {})
      : state{centre, {}, surface_velocity, surface_spin}
  {
  }

  RigidState at(double) const override { return state; }
  bool slides_in_place() const override
  {
    return norm_square(state.velocity) + norm_square(state.angular_velocity) > 0.;
  }

private:
  const RigidState state;
};

/// A solid that moves at a constant velocity, or turns about its centre at a constant speed; both
/// begin at the origin and with its own axes.
class SteadyMotion : public Motion
{
public:
  SteadyMotion(const Vec3 &velocity, const Vec3 &angular_velocity)
      : velocity(velocity), angular_velocity(angular_velocity)
  {
  }

  RigidState at(double time) const override
  {
    return {time * velocity, Rotation::by(time * angular_velocity), velocity, angular_velocity};
  }
  bool rotates() const override { return norm_square(angular_velocity) > 0.; }

private:
  const Vec3 velocity, angular_velocity;
};

} // namespace eunoe

#endif
