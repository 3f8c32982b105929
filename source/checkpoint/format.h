#ifndef eunoe_source_checkpoint_format_h
#define eunoe_source_checkpoint_format_h

// What the writer and the reader of checkpoints share.

#include <boost/crc.hpp>

#include <cstdint>
#include <mpi.h>
#include <string>

namespace eunoe::checkpoint_format {

inline const std::string format_name = "Eunoe checkpoint ", format_version = "5";

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

} // namespace eunoe::checkpoint_format

#endif
