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

// In every version the file ends with the CRC-32 of all before it. So a program can tell a file of
// a later version that is whole, which it refuses, from a damaged one, for which it takes an older.
inline const std::string format_name = "Eunoe checkpoint ", format_version = "7";

/// The version before, without checksums of chunks and with the same contents: it is read, too.
inline const std::string version_without_chunks = "6";

/// Bytes of a chunk, which has a checksum of its own, so that a message can say where a file is
/// damaged: about a stripe of a parallel file system, as that is what gets lost. 10^8 particles
/// (50 GB) have 12,000 chunks, so every rank can hold the checksums of all, 48 kB. Another number
/// is another format.
inline constexpr std::uint64_t chunk_length = std::uint64_t(1) << 22;

/// zlib counts bytes in 32 bits.
inline constexpr std::uint64_t most_at_once = std::uint64_t(1) << 30;

/// CRC-32 of bytes, to which more can be added.
struct Checksum
{
  std::uint64_t value = 0, n_bytes = 0;

  void add(const void *data, std::uint64_t n)
  {
    for (std::uint64_t begin = 0; begin < n; begin += most_at_once)
      value = crc32(value, static_cast<const Bytef *>(data) + begin,
                    static_cast<uInt>(std::min(most_at_once, n - begin)));
    n_bytes += n;
  }

  /// Adds bytes of which only the checksum is known.
  void append(const Checksum &next)
  {
    value = crc32_combine(value, next.value, static_cast<z_off_t>(next.n_bytes));
    n_bytes += next.n_bytes;
  }
};

/// CRC-32 of every chunk of a file. Each rank adds the bytes that it has, in any order: a CRC is
/// linear, so that of a chunk is the exclusive or of those of its pieces, each followed by as many
/// zeros as there are bytes behind the piece.
struct ChunkChecksums
{
  /// @param n_bytes more than 0
  /// @param length of the chunks but the last
  ChunkChecksums(std::uint64_t n_bytes, std::uint64_t length)
      : n_bytes(n_bytes), length(length), values((n_bytes + length - 1) / length)
  {
  }

  std::uint64_t begin_of(std::uint64_t chunk) const { return chunk * length; }
  std::uint64_t end_of(std::uint64_t chunk) const
  {
    return std::min((chunk + 1) * length, n_bytes);
  }

  /// Adds bytes of the file that no one else adds.
  void add(std::uint64_t begin, const void *const data, const std::uint64_t n)
  {
    const Bytef *from = static_cast<const Bytef *>(data);
    const std::uint64_t end = begin + n;
    while (begin < end) {
      const std::uint64_t chunk = begin / length;
      const std::uint64_t here = std::min(most_at_once, std::min(end, end_of(chunk)) - begin);
      const std::uint64_t behind = end_of(chunk) - begin - here;
      values[chunk] ^= static_cast<std::uint32_t>(
          crc32_combine(crc32(0, from, static_cast<uInt>(here)), 0, static_cast<z_off_t>(behind)));
      begin += here;
      from += here;
    }
  }

  /// Brings what all ranks have added together on the first one; collective.
  void join(MPI_Comm comm)
  {
    std::vector<std::uint32_t> joined(values.size());
    MPI_Reduce(values.data(), joined.data(), static_cast<int>(values.size()), MPI_UINT32_T,
               MPI_BXOR, 0, comm);
    values.swap(joined);
  }

  /// Of all chunks together.
  Checksum of_contents() const
  {
    Checksum all;
    for (std::uint64_t chunk = 0; chunk < values.size(); ++chunk)
      all.append({values[chunk], end_of(chunk) - begin_of(chunk)});
    return all;
  }

  /// Of all chunks and what stands behind them: their number of bytes and their checksums. (Of one
  /// chunk and its checksum alone it would be the same number for any chunk.)
  std::uint64_t of_all() const
  {
    Checksum all = of_contents();
    all.add(&n_bytes, sizeof n_bytes);
    all.add(values.data(), values.size() * sizeof(std::uint32_t));
    return all.value;
  }

  std::uint64_t n_bytes, length;
  std::vector<std::uint32_t> values; ///< one of each chunk
};

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
