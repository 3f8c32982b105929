#ifndef eunoe_core_messages_h
#define eunoe_core_messages_h

#include <algorithm>
#include <cstdint>
#include <mpi.h>

namespace eunoe {

// Messages of any size, in parts that MPI can count.

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

} // namespace eunoe

#endif
