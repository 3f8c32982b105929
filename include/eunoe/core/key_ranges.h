#ifndef eunoe_core_key_ranges_h
#define eunoe_core_key_ranges_h

#include <algorithm>
#include <cstdint>
#include <limits>
#include <mpi.h>
#include <vector>

namespace eunoe {

/// The rank that gets each key when keys are sorted over all ranks: the range of the keys is cut
/// where the ranks have equal numbers of them, as nearly as equal parts of the range allow. What a
/// rank knows of all keys does not grow with their number or that of the ranks.
class KeyRanges
{
public:
  static constexpr int n_parts = 1 << 16;

  /// Collective.
  KeyRanges(const std::vector<std::uint32_t> &keys, MPI_Comm comm);
  /// @param counts numbers of keys of all ranks in the parts of the range
  KeyRanges(std::uint32_t smallest, std::uint32_t largest, const std::vector<std::uint64_t> &counts,
            int n_ranks);

  /// One that is out of the range is taken for the nearest in it.
  int rank(const std::uint32_t key) const { return ranks[part(key)]; }

private:
  std::uint32_t part(const std::uint32_t key) const
  {
    constexpr std::uint32_t last = n_parts - 1;
    return key < smallest ? 0 : std::min(last, (key - smallest) / width);
  }
  void set_width(std::uint32_t largest);
  void share_out(const std::vector<std::uint64_t> &counts, int n_ranks);

  std::uint32_t smallest = std::numeric_limits<std::uint32_t>::max(), width = 1;
  std::vector<int> ranks; ///< by part
};

/// Ways of messages when every rank has something for nearly every other one. The ranks stand in a
/// square, and a message goes first within its row, then within a column, so that a rank has twice
/// as many partners as the square is wide, not as many as there are ranks.
class SquareRoutes
{
public:
  explicit SquareRoutes(int n_ranks);

  /// The rank between two others.
  int via(int from, int to) const;

private:
  int n_ranks, width;
};

/// The places of some keys in the order of the keys of all ranks; collective.
/// @param keys different from each other on all ranks
/// @param asked each once
/// @return for each that is asked for, how many keys of all ranks are smaller; -1 where it is none
///         of them
std::vector<std::int64_t> places_in_order(const std::vector<std::uint32_t> &keys,
                                          const std::vector<std::uint32_t> &asked, MPI_Comm comm);

} // namespace eunoe

#endif
