#ifndef eunoe_solids_expression_motion_h
#define eunoe_solids_expression_motion_h

#include <eunoe/solids/motion.h>

#include <memory>
#include <string>

namespace eunoe {

/// Motion given by expressions for the velocity of the centre and the angular velocity about it,
/// in terms of the centre's coordinates x, y, z and of the time t.
///
/// The path follows from them by a Runge-Kutta scheme of fourth order with fixed steps from time
/// zero, so it is a function of time alone; what has been integrated is kept.
class ExpressionMotion : public Motion
{
public:
  /// @param velocity, angular_velocity three expressions separated by ';' (m/s, rad/s)
  /// @param constants "name=value, ..." for either
  /// @param time_step of the integration (s)
  /// Throws std::invalid_argument with a sentence for expressions that make no sense.
  ExpressionMotion(const Vec3 &centre, const std::string &velocity,
                   const std::string &velocity_constants, const std::string &angular_velocity,
                   const std::string &angular_velocity_constants, double time_step);
  ~ExpressionMotion() override;

  RigidState at(double time) const override;
  bool rotates() const override { return has_rotation; }

private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation;
  bool has_rotation;
};

} // namespace eunoe

#endif
