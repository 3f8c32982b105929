#include <eunoe/core/message_tags.h>
#include <eunoe/core/sparse_exchange.h>

#include <deal.II/base/mpi.h>

namespace eunoe {

std::map<int, int> numbers_from(const std::map<int, int> &numbers_to, MPI_Comm comm)
{
  const std::map<unsigned int, int> to(numbers_to.begin(), numbers_to.end());
  const std::map<unsigned int, int> from = dealii::Utilities::MPI::some_to_some(comm, to);
  return {from.begin(), from.end()};
}

void exchange_entries(const std::map<int, std::pair<const void *, int>> &to, const std::size_t size,
                      const std::function<void *(int rank, int number)> &room, MPI_Comm comm)
{
  MPI_Datatype entry;
  MPI_Type_contiguous(static_cast<int>(size), MPI_BYTE, &entry);
  MPI_Type_commit(&entry);
  std::map<int, int> numbers_to;
  for (const auto &[rank, list] : to)
    numbers_to[rank] = list.second;
  const std::map<int, int> numbers = numbers_from(numbers_to, comm);
  std::vector<MPI_Request> requests;
  requests.reserve(numbers.size() + to.size());
  for (const auto &[rank, number] : numbers) {
    requests.emplace_back();
    MPI_Irecv(room(rank, number), number, entry, rank, tag_entries, comm, &requests.back());
  }
  for (const auto &[rank, list] : to) {
    requests.emplace_back();
    MPI_Isend(list.first, list.second, entry, rank, tag_entries, comm, &requests.back());
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  MPI_Type_free(&entry);
}

} // namespace eunoe
