#ifndef eunoe_core_gather_h
#define eunoe_core_gather_h

#include <mpi.h>
#include <type_traits>
#include <vector>

namespace eunoe {

/// How many entries of a list each rank has, and where they begin in the list of all.
struct RankShares
{
  /// Collective.
  /// @param n number of this rank's entries
  RankShares(std::size_t n, MPI_Comm comm);

  std::size_t total() const { return static_cast<std::size_t>(starts.back() + counts.back()); }

  std::vector<int> counts, starts; ///< one per rank
};

/// Brings the entries of all ranks to every rank; collective.
/// @param size of an entry (bytes)
/// @param all room for all of them
void gather_entries(const void *mine, std::size_t size, const RankShares &shares, void *all,
                    MPI_Comm comm);

/// The entries of all ranks, by rank, on every rank; collective.
template <typename Entry>
std::vector<Entry> gather_all(const std::vector<Entry> &mine, MPI_Comm comm)
{
  static_assert(std::is_trivially_copyable_v<Entry>);
  const RankShares shares(mine.size(), comm);
  std::vector<Entry> all(shares.total());
  gather_entries(mine.data(), sizeof(Entry), shares, all.data(), comm);
  return all;
}

} // namespace eunoe

#endif
