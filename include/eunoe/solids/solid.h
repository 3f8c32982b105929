#ifndef eunoe_solids_solid_h
#define eunoe_solids_solid_h

#include <eunoe/core/exact_sum.h>
#include <eunoe/solids/motion.h>
#include <eunoe/solids/shape.h>

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace eunoe {

/// A shape that moves as prescribed and that particles touch: a plate, a spreader, a wall of the
/// domain, a floating wall.
struct Solid
{
  std::string name; ///< in the input and in messages
  /// Id of the boundary of the mesh that it is a wall of, if it is one.
  std::optional<unsigned int> boundary;
  /// Number of the solid object of the input that it is, if it is one.
  std::optional<unsigned int> object;
  std::shared_ptr<const Shape> shape;
  std::shared_ptr<const Motion> motion;
  /// Row among the Materials.
  int material = 0;
  /// The solid acts while start <= t <= end (s).
  double start = -std::numeric_limits<double>::infinity();
  double end = std::numeric_limits<double>::infinity();
  /// Whether it is drawn.
  bool output = true;

  /// State at the time of the last force evaluation.
  RigidState state;

  bool is_active(double time) const { return time >= start && time <= end; }

  /// A point of space in the solid's own frame.
  Vec3 to_own_frame(const Vec3 &x) const
  {
    const Vec3 d = x - state.centre;
    return motion->rotates() ? state.rotation.undo(d) : d;
  }
  /// A direction of the solid's own frame in space.
  Vec3 to_space(const Vec3 &direction) const
  {
    return motion->rotates() ? state.rotation.apply(direction) : direction;
  }
};

/// A solid among those of a run, as the one who added it knows it.
struct SolidHandle
{
  std::size_t number = 0;
};

inline SolidHandle add_solid(std::vector<Solid> &solids, Solid solid)
{
  solids.push_back(std::move(solid));
  return {solids.size() - 1};
}

/// Largest distance that a point of a solid has moved between two states (m).
double displacement(const Solid &solid, const RigidState &before, const RigidState &after);

/// Sum of the forces (N) and torques about the solid's centre (N m) that the particles exert on a
/// solid; exact, hence the same on any number of ranks.
struct SolidLoad
{
  std::array<ExactSum, 3> force, torque;

  /// @param more_torque about the solid's centre (N m)
  void add(const Vec3 &more_force, const Vec3 &more_torque)
  {
    for (unsigned int d = 0; d < 3; ++d) {
      force[d] += more_force[d];
      torque[d] += more_torque[d];
    }
  }
};

} // namespace eunoe

#endif
