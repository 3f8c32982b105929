#ifndef eunoe_core_random_h
#define eunoe_core_random_h

#include <array>
#include <cstdint>

namespace eunoe {

/// What a random number is for; numbers for different purposes are independent.
enum class Draw : std::uint32_t
{
  size = 1,
  offset = 2,
  feed_copy = 3,
  packing = 4
};

/// Philox 4x32-10, a counter-based generator (Salmon, Moraes, Dror, Shaw 2011): a function of its
/// counter and key, without state.
std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter,
                                    std::array<std::uint32_t, 2> key);

/// Uniform number in [0, 1) that depends on its arguments only, never on rank or order.
/// @param id of the particle or event
/// @param index to draw several numbers for one id
double uniform(std::uint32_t seed, Draw purpose, std::uint64_t id, std::uint32_t index = 0);

} // namespace eunoe

#endif
