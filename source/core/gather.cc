#include <eunoe/core/gather.h>

#include <numeric>

namespace eunoe {

namespace {

/// An entry of some bytes as MPI counts it, so that numbers of entries need to be integers, not
/// numbers of bytes.
class EntryType
{
public:
  explicit EntryType(std::size_t size)
  {
    MPI_Type_contiguous(static_cast<int>(size), MPI_BYTE, &type);
    MPI_Type_commit(&type);
  }
  ~EntryType() { MPI_Type_free(&type); }
  EntryType(const EntryType &) = delete;
  EntryType &operator=(const EntryType &) = delete;

  MPI_Datatype type = MPI_DATATYPE_NULL;
};

int rank_in(MPI_Comm comm)
{
  int rank;
  MPI_Comm_rank(comm, &rank);
  return rank;
}

} // namespace

RankShares::RankShares(const std::size_t n, MPI_Comm comm)
{
  int n_ranks;
  MPI_Comm_size(comm, &n_ranks);
  counts.resize(n_ranks);
  starts.assign(n_ranks, 0);
  const int count = static_cast<int>(n);
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, comm);
  std::partial_sum(counts.begin(), counts.end() - 1, starts.begin() + 1);
}

void gather_entries(const void *mine, const std::size_t size, const RankShares &shares, void *all,
                    MPI_Comm comm)
{
  const EntryType entry(size);
  MPI_Allgatherv(mine, shares.counts[rank_in(comm)], entry.type, all, shares.counts.data(),
                 shares.starts.data(), entry.type, comm);
}

} // namespace eunoe
