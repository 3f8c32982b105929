#ifndef eunoe_state_particle_arrays_h
#define eunoe_state_particle_arrays_h

#include <eunoe/core/vec3.h>
#include <eunoe/state/particle_field.h>
#include <eunoe/state/remaining.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

namespace eunoe {

/// Identity of a particle, unique over the whole run and never used again.
using ParticleId = std::uint32_t;

/// The largest two of some numbers that are not negative. They do not depend on the order in which
/// these come.
struct TwoLargest
{
  double first = 0., second = 0.;

  /// Takes in one more, without a branch. What is not a number changes nothing.
  void note(const double value)
  {
    const double lesser = first < value ? first : value;
    second = lesser > second ? lesser : second;
    first = value > first ? value : first;
  }
};

/// How far particles have gone: squares. Steps are infinite if they are not known.
struct Travel
{
  static constexpr double unknown = std::numeric_limits<double>::infinity();

  double moved2; ///< at most from the reference positions (m2), NaN if a place is not a number
  double paces2 = unknown;     ///< at most in this step, over the particle's pace
  double mean_step2 = unknown; ///< of those that are awake, in this step (m2)
  double second2 = unknown;    ///< of the second farthest, as moved2; infinite if it is not known

  /// From the reference positions; the second as far as the first if it is not known (m2).
  TwoLargest farthest2() const { return {moved2, std::min(moved2, second2)}; }

  /// Takes in the displacements of further particles (m2). NaN stays NaN.
  void include(const TwoLargest &others)
  {
    TwoLargest all = farthest2();
    all.note(others.first);
    all.note(others.second);
    moved2 = all.first;
    second2 = all.second;
  }
};

/// The hot state of the particles that a rank computes with: those that it owns, then copies of
/// those that its neighbours own (ghosts), each part ordered by the (contact-grid cell, id) that
/// its references had when the particle store was last read. SI units.
struct ParticleArrays
{
  std::size_t n_owned = 0, n_ghosts = 0;

  std::vector<Quad> position; ///< x, y, z and radius
  std::vector<Quad> velocity; ///< velocity and mass
  std::vector<Quad> spin;     ///< angular velocity and moment of inertia
  std::vector<Quad> force;    ///< force; w unused
  std::vector<Quad> torque;   ///< torque; w unused
  Vec3 gravity;               ///< acceleration by which every particle has its weight (m/s2)
  std::vector<ParticleId> id;
  std::vector<std::int32_t> type; ///< particle type, which is its material
  /// Step that the particle is expected to make at most for a while (m), see NearPairs; the same on
  /// all ranks that have it.
  std::vector<float> pace;

  /// @name Awake particles (see SparseContacts)
  ///@{
  std::vector<std::uint8_t> awake;        ///< a flag each, ghosts too; empty while all are awake
  std::vector<std::int32_t> awake_rows;   ///< of owned particles, ascending; empty while all are
  std::vector<std::int32_t> pressed_rows; ///< of owned sleepers that feel forces
  /// Squares of the largest two distances of owned sleepers from their reference positions (m2).
  TwoLargest sleepers_moved2;
  bool is_awake(std::size_t row) const { return awake.empty() || awake[row] != 0; }
  std::size_t n_awake() const { return awake.empty() ? n_owned : awake_rows.size(); }
  ///@}

  /// Where a particle stands in the lists of what can touch (m): its position at one of the last
  /// searches, wrapped at periods.
  std::vector<Vec3> reference;

  /// @name Owned particles only
  ///@{
  /// The extra doubles of all fields, `[component][particle]`, for those who store them. A field is
  /// found by its handle.
  std::vector<std::vector<double>> extra;
  std::vector<double> &component(FieldHandle field, unsigned int d = 0)
  {
    return extra[field.first + d];
  }
  Vec3 vector(FieldHandle field, std::size_t row) const
  {
    return {extra[field.first][row], extra[field.first + 1][row], extra[field.first + 2][row]};
  }
  void set_vector(FieldHandle field, std::size_t row, const Vec3 &value)
  {
    for (unsigned int d = 0; d < 3; ++d)
      extra[field.first + d][row] = value[d];
  }
  ///@}

  std::size_t size() const { return n_owned + n_ghosts; }

  /// @name What stands beside the vectors, as kernels read it in one access
  ///@{
  double radius(std::size_t row) const { return position[row].w; }
  double mass(std::size_t row) const { return velocity[row].w; }
  double moment_of_inertia(std::size_t row) const { return spin[row].w; }
  ///@}

  /// All are awake afterwards.
  void resize(std::size_t owned, std::size_t ghosts, unsigned int n_extra);

  /// Takes particles out; all are awake afterwards.
  void leave_out(const Remaining &remaining);

  void wake_all();

  /// Begins the sums of a particle's forces and torques: it has its weight, to which loads and
  /// contacts are added. The weight is added to zero, so that no zero has a sign.
  void start_forces(const std::size_t row)
  {
    const double m = mass(row);
    force[row] = {0. + m * gravity.x, 0. + m * gravity.y, 0. + m * gravity.z, 0.};
    torque[row] = Quad();
  }
  /// Whether the sums of all that are awake have just begun.
  bool have_their_weights() const;
  /// Forces on sleepers have no meaning, and must not add up over the steps.
  void clear_forces_on_sleepers();
  /// Only on those that feel any.
  void clear_forces_on_pressed();

  /// Calls `action(row)` for every owned particle that is awake.
  template <typename Action>
  void for_each_awake(const Action &action) const
  {
    if (awake.empty())
      for (std::size_t row = 0; row < n_owned; ++row)
        action(row);
    else
      for (const std::int32_t row : awake_rows)
        action(static_cast<std::size_t>(row));
  }
};

} // namespace eunoe

#endif
