#ifndef eunoe_source_checkpoint_format_h
#define eunoe_source_checkpoint_format_h

// What the writer and the reader of checkpoints share.

#include <algorithm>
#include <cstdint>
#include <mpi.h>
#include <string>
#include <vector>
#include <zlib.h>

namespace eunoe::checkpoint_format {

inline const std::string format_name = "Eunoe checkpoint ", format_version = "6";

/// CRC-32 of a part of a file. Those of parts give that of the whole, so that each rank can look at
/// its own part.
struct Checksum
{
  std::uint64_t value = 0, n_bytes = 0;

  void add(const void *data, std::uint64_t n)
  {
    constexpr std::uint64_t part = 1u << 30;
    for (std::uint64_t begin = 0; begin < n; begin += part)
      value = crc32(value, static_cast<const Bytef *>(data) + begin,
                    static_cast<uInt>(std::min(part, n - begin)));
    n_bytes += n;
  }

  /// Adds the part of a file that comes next.
  void append(const Checksum &next)
  {
    value = crc32_combine(value, next.value, static_cast<z_off_t>(next.n_bytes));
    n_bytes += next.n_bytes;
  }
};

/// Joins the pieces that the ranks have of each part, in the order of the ranks, on the first rank;
/// no rank holds those of all; collective.
inline void join_pieces(std::vector<Checksum> &pieces, MPI_Comm comm)
{
  static_assert(sizeof(Checksum) == 2 * sizeof(std::uint64_t));
  MPI_Datatype type;
  MPI_Type_contiguous(2, MPI_UINT64_T, &type);
  MPI_Type_commit(&type);
  MPI_Op join;
  MPI_Op_create(
      [](void *before, void *behind, int *n, MPI_Datatype *) {
        for (int k = 0; k < *n; ++k) {
          Checksum joined = static_cast<Checksum *>(before)[k];
          joined.append(static_cast<Checksum *>(behind)[k]);
          static_cast<Checksum *>(behind)[k] = joined;
        }
      },
      0, &join);
  std::vector<Checksum> joined(pieces.size());
  MPI_Reduce(pieces.data(), joined.data(), static_cast<int>(pieces.size()), type, join, 0, comm);
  MPI_Op_free(&join);
  MPI_Type_free(&type);
  pieces = joined;
}

inline int rank_in(MPI_Comm comm)
{
  int rank;
  MPI_Comm_rank(comm, &rank);
  return rank;
}

inline int size_of(MPI_Comm comm)
{
  int size;
  MPI_Comm_size(comm, &size);
  return size;
}

/// First of the items that belong to a rank.
inline std::uint64_t first_of(std::uint64_t n, int rank, int n_ranks)
{
  return n * static_cast<std::uint64_t>(rank) / static_cast<std::uint64_t>(n_ranks);
}

} // namespace eunoe::checkpoint_format

#endif
