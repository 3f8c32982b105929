#ifndef eunoe_source_checkpoint_format_h
#define eunoe_source_checkpoint_format_h

// What the writer and the reader of checkpoints share.

#include <eunoe/core/problems.h>

#include <boost/crc.hpp>

#include <algorithm>
#include <cstdint>
#include <mpi.h>
#include <string>

namespace eunoe::checkpoint_format {

inline const std::string format_name = "Eunoe checkpoint ", format_version = "2";

/// CRC-64 of ECMA-182.
using Checksum = boost::crc_optimal<64, 0x42F0E1EBA9EA3693, 0, 0, false, false>;

constexpr int tag_lengths = 321, tag_values = 322;

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

/// Messages of any size in parts that MPI can count.
inline void send(const void *data, std::uint64_t n_bytes, int to, int tag, MPI_Comm comm)
{
  constexpr std::uint64_t part = 1u << 30;
  for (std::uint64_t begin = 0; begin < n_bytes; begin += part)
    MPI_Send(static_cast<const char *>(data) + begin,
             static_cast<int>(std::min(part, n_bytes - begin)), MPI_BYTE, to, tag, comm);
}

inline void receive(void *data, std::uint64_t n_bytes, int from, int tag, MPI_Comm comm)
{
  constexpr std::uint64_t part = 1u << 30;
  for (std::uint64_t begin = 0; begin < n_bytes; begin += part)
    MPI_Recv(static_cast<char *>(data) + begin, static_cast<int>(std::min(part, n_bytes - begin)),
             MPI_BYTE, from, tag, comm, MPI_STATUS_IGNORE);
}

/// Gives an error of the first rank to all, who throw it.
inline void agree(std::string error, MPI_Comm comm)
{
  int size = static_cast<int>(error.size());
  MPI_Bcast(&size, 1, MPI_INT, 0, comm);
  error.resize(size);
  MPI_Bcast(error.data(), size, MPI_CHAR, 0, comm);
  if (!error.empty())
    throw UserError(error);
}

} // namespace eunoe::checkpoint_format

#endif
