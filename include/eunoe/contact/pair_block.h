#ifndef eunoe_contact_pair_block_h
#define eunoe_contact_pair_block_h

#include <array>
#include <cstdint>

namespace eunoe {

/// What the laws of a batch of contacts write; all zero before the first.
struct alignas(64) ContactForces
{
  static constexpr unsigned int size = 32;
  using Lanes = double[size];

  alignas(64) Lanes stiffness;      ///< normal secant stiffness k_n (N/m)
  alignas(64) Lanes contact_radius; ///< of the area in which the bodies touch, 0 if none (m)
  alignas(64) Lanes damping_root;   ///< root of contact radius and mass, for dampers (m kg)^(1/2)
  alignas(64) Lanes contact_force;  ///< normal elastic + damping force, repulsion positive (N)
  alignas(64) Lanes cohesion;       ///< attraction positive, remote repulsion negative (N)
  alignas(64) Lanes shear_x, shear_y, shear_z;    ///< tangential force on j (N)
  alignas(64) Lanes torque_x, torque_y, torque_z; ///< rolling-resistance torque on i (N m)
};

/// A batch of contacts, one array per quantity, on which every active law runs one vector loop.
///
/// Body i is always a particle; body j is a particle or a piece of a solid surface (infinite
/// radius and mass). The normal points from i to j. What the laws write acts **on j**; i feels
/// the opposite. Unused places at the end hold copies of a valid contact, so that every loop runs
/// over the whole block with the same arithmetic for each pair.
///
/// SI units throughout. Formulas and sign conventions: doc/physics.md.
struct alignas(64) PairBlock : ContactForces
{
  static constexpr unsigned int max_history = 12;

  /// Number of real contacts, the first ones.
  unsigned int n = 0;
  /// Row in every law's table of coefficients, shared by the whole block if >= 0 ...
  int uniform_kind = -1;
  /// ... else one per contact.
  const std::int32_t *kind = nullptr;

  /// @name Written by the geometry, read by the laws
  ///@{
  alignas(64) Lanes nx, ny, nz;    ///< unit normal from i to j
  alignas(64) Lanes overlap;       ///< positive in contact, else negative (m)
  alignas(64) Lanes distance;      ///< of the centres, or of a centre from a solid's surface (m)
  alignas(64) Lanes radius;        ///< effective radius (m)
  alignas(64) Lanes mass;          ///< effective mass (kg)
  alignas(64) Lanes inertia;       ///< effective moment of inertia about the centres (kg m2)
  alignas(64) Lanes closing_speed; ///< normal velocity of i against j, positive in approach (m/s)
  alignas(64) Lanes slip_x, slip_y, slip_z; ///< tangential velocity of i's surface against j's
  alignas(64) Lanes roll_x, roll_y, roll_z; ///< spin of i less spin of j, without twist (rad/s)
  alignas(64) Lanes twist;                  ///< spin of i less spin of j about the normal (rad/s)
  ///@}

  /// What the contacts remember, `[component][contact]`; each law owns a range of components.
  Lanes *history = nullptr;
};

/// A block that has room of its own for what it points to.
struct alignas(64) OwnPairBlock : PairBlock
{
  OwnPairBlock()
  {
    kind = own_kind;
    history = own_history;
  }
  OwnPairBlock(const OwnPairBlock &) = delete;
  OwnPairBlock &operator=(const OwnPairBlock &) = delete;

  std::int32_t own_kind[size];
  alignas(64) Lanes own_history[max_history];
};

} // namespace eunoe

#endif
