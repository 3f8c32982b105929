#ifndef eunoe_core_sparse_exchange_h
#define eunoe_core_sparse_exchange_h

#include <functional>
#include <map>
#include <mpi.h>
#include <type_traits>
#include <vector>

namespace eunoe {

// Messages to some ranks, of which the receivers know nothing beforehand. The work grows with the
// ranks that have something to tell each other, not with all.

/// Tells each rank a number and returns what others tell this one, by rank; collective.
std::map<int, int> numbers_from(const std::map<int, int> &numbers_to, MPI_Comm comm);

/// Sends lists of entries of @p size bytes, not those for this rank; collective.
/// @param to by rank: begin of the entries, and their number
/// @param room gives the memory for entries that come from a rank
void exchange_entries(const std::map<int, std::pair<const void *, int>> &to, std::size_t size,
                      const std::function<void *(int rank, int number)> &room, MPI_Comm comm);

/// Sends a list to each rank and returns the lists that come, by rank. What a rank has for itself
/// comes back to it. Lists may not be empty; collective.
template <typename Entry>
std::map<int, std::vector<Entry>> exchange_lists(std::map<int, std::vector<Entry>> &&to,
                                                 MPI_Comm comm)
{
  static_assert(std::is_trivially_copyable_v<Entry>);
  int own_rank;
  MPI_Comm_rank(comm, &own_rank);
  std::map<int, std::vector<Entry>> from;
  std::map<int, std::pair<const void *, int>> lists;
  for (auto &[rank, list] : to)
    if (rank == own_rank)
      from[rank] = std::move(list);
    else
      lists[rank] = {list.data(), static_cast<int>(list.size())};
  exchange_entries(
      lists, sizeof(Entry),
      [&from](const int rank, const int number) {
        from[rank].resize(static_cast<std::size_t>(number));
        return static_cast<void *>(from[rank].data());
      },
      comm);
  return from;
}

} // namespace eunoe

#endif
