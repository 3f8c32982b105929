#ifndef eunoe_solids_placement_h
#define eunoe_solids_placement_h

#include <eunoe/core/parameter_section.h>
#include <eunoe/solids/motion.h>

namespace eunoe {

/// Where a mesh is put before the run: its coordinates are scaled, then turned about an axis
/// through the origin, then shifted.
struct Placement
{
  double scale = 1.;
  Vec3 axis = {1., 0., 0.};
  double angle = 0.; ///< (rad)
  Vec3 translation;  ///< (m)

  /// Whether nothing changes.
  bool is_identity() const { return scale == 1. && angle == 0. && norm(translation) == 0.; }

  Vec3 operator()(const Vec3 &x) const
  {
    const Vec3 scaled = scale * x;
    return (angle == 0. ? scaled : Rotation::by(angle / norm(axis) * axis).apply(scaled)) +
           translation;
  }

  /// The place before, of a place after.
  Vec3 undo(const Vec3 &x) const
  {
    const Vec3 shifted = x - translation;
    return (angle == 0. ? shifted : Rotation::by(angle / norm(axis) * axis).undo(shifted)) / scale;
  }

  /// Declares the entries in the present subsection.
  void declare(dealii::ParameterHandler &prm);
  void check(const ParameterCheck &check, const ParameterCheck::Path &path) const;
};

} // namespace eunoe

#endif
