#ifndef eunoe_source_contact_pair_kernels_h
#define eunoe_source_contact_pair_kernels_h

#include <eunoe/contact/contact_memory.h>
#include <eunoe/core/periodic_box.h>
#include <eunoe/state/particle_arrays.h>

namespace eunoe {

struct Period
{
  explicit Period(const PeriodicBox &box) : length(box.length), half(box.half()) {}

  Vec3 length, half;
};

/// Where a particle's row begins in an array of quads (bytes): one multiplication less for each
/// access. Enough for 134 million particles on a rank.
using Offset = std::uint32_t;
inline Offset offset_of(const std::int32_t row)
{
  return static_cast<Offset>(row) * static_cast<Offset>(sizeof(Quad));
}
inline std::size_t row_of(const Offset offset)
{
  return offset / sizeof(Quad);
}

/// A block of pairs of particles.
struct ParticleBlock : OwnPairBlock
{
  const Offset *i = nullptr, *j = nullptr; ///< the particles
  alignas(64) Lanes radius_i, radius_j;
  alignas(64) Lanes is_out; ///< 1 for pairs that are out of reach, else 0
  Offset own_i[size], own_j[size];
};

/// Bits of the pairs of a block whose separation is at most @p range (m).
std::uint64_t within(const Quad *position, const Offset *i, const Offset *j, const Period &period,
                     double range);

/// Bits of the pairs of a block whose distance is at most @p factor times the sum of their radii,
/// @p range (m) and so many paces of both.
std::uint64_t within_paces(const ParticleArrays &p, const Offset *i, const Offset *j,
                           const Period &period, double range, double n_paces, double factor);

/// Fills in the geometry and kinematics of a block of pairs.
/// @param range separation beyond which a pair is out of reach (m)
/// @return bits of the pairs that are within reach
std::uint64_t describe(ParticleBlock &b, const ParticleArrays &p, const Period &period,
                       double range);

/// Adds the forces and torques of a block to both particles of every pair within reach, pair by
/// pair.
void add(const ParticleBlock &b, ParticleArrays &p);

/// Adds those of block @p last and describes block @p next, a few pairs of each in turn: adding
/// waits for memory, which describing does not.
std::uint64_t add_and_describe(const ParticleBlock &last, ParticleBlock &next, ParticleArrays &p,
                               const Period &period, double range);

/// Copies records to the lanes of a block.
void recall(PairBlock &b, const ContactMemory &memory, const std::int32_t *record);

/// Copies the lanes of a block to their records.
void remember(const PairBlock &b, ContactMemory &memory, const std::int32_t *record);

} // namespace eunoe

#endif
