#include <eunoe/core/declare.h>
#include <eunoe/solids/placement.h>

namespace eunoe {

void Placement::declare(dealii::ParameterHandler &prm)
{
  declare::not_negative(prm, "scale", scale, "Factor on all coordinates.");
  declare::vector(prm, "initial rotation axis", axis,
                  "Axis through the origin about which the scaled mesh is turned.");
  declare::entry(prm, "initial rotation angle", angle, "Angle of that turn (rad).");
  declare::vector(prm, "initial translation", translation, "Shift after the turn (m).");
}

void Placement::check(const ParameterCheck &check, const ParameterCheck::Path &path) const
{
  check.require(scale > 0., path, "scale", "is " + format(scale) + ".", "Give a positive factor.");
  check.require(angle == 0. || norm(axis) > 0., path, "initial rotation axis", "is zero.",
                "Give the direction of the axis.");
}

} // namespace eunoe
