#ifndef eunoe_solids_motion_section_h
#define eunoe_solids_motion_section_h

#include <eunoe/core/parameter_section.h>
#include <eunoe/core/registry.h>
#include <eunoe/solids/motion.h>

#include <memory>

namespace eunoe {

/// What the input says of one kind of motion of a solid, in entries that the motion's own file
/// declares in the subsection of the solid object.
class MotionSection
{
public:
  virtual ~MotionSection() = default;

  virtual void declare(dealii::ParameterHandler &prm) = 0;

  /// @param path of the solid object
  virtual void check(const ParameterCheck &, const ParameterCheck::Path & /*path*/) const {}

  /// Null where the entries ask for no such motion. Throws a std::invalid_argument with sentences
  /// for entries that make no sense.
  /// @param centre of rotation at the start (m)
  /// @param time_step with which velocities are integrated (s)
  virtual std::unique_ptr<Motion> make(const Vec3 &centre, double time_step) const = 0;
};

using MotionRegistry = Registry<std::unique_ptr<MotionSection>>;
MotionRegistry &solid_motions();

} // namespace eunoe

#endif
