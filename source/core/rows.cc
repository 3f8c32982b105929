#include <eunoe/core/rows.h>

#include <numeric>

namespace eunoe {

namespace {

constexpr int tag_rows = 301, tag_lengths = 302, tag_values = 303;

/// Messages under way.
class Messages
{
public:
  explicit Messages(MPI_Comm comm) : comm(comm) {}

  /// Nothing is sent where there is nothing; the receiver knows.
  template <typename Number>
  void send(const std::vector<Number> &data, MPI_Datatype type, int to, int tag)
  {
    if (data.empty())
      return;
    requests.emplace_back();
    MPI_Isend(data.data(), static_cast<int>(data.size()), type, to, tag, comm, &requests.back());
  }

  template <typename Number>
  void receive(std::vector<Number> &data, MPI_Datatype type, int from, int tag)
  {
    if (data.empty())
      return;
    requests.emplace_back();
    MPI_Irecv(data.data(), static_cast<int>(data.size()), type, from, tag, comm, &requests.back());
  }

  void wait()
  {
    MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
    requests.clear();
  }

private:
  MPI_Comm comm;
  std::vector<MPI_Request> requests;
};

/// Rows that other ranks kept, by rank and in the order in which they were asked for.
struct Fetched
{
  std::vector<std::vector<int>> lengths;
  std::vector<std::vector<double>> values;
};

/// Asks every rank for rows that it kept: first how many, then which, then their contents.
/// @param wanted by rank
Fetched fetch(const Rows &kept, const std::vector<std::vector<int>> &wanted, MPI_Comm comm)
{
  const int n_ranks = static_cast<int>(wanted.size());
  std::vector<int> n_wanted(n_ranks), n_asked(n_ranks);
  for (int r = 0; r < n_ranks; ++r)
    n_wanted[r] = static_cast<int>(wanted[r].size());
  MPI_Alltoall(n_wanted.data(), 1, MPI_INT, n_asked.data(), 1, MPI_INT, comm);

  Messages messages(comm);
  std::vector<std::vector<int>> asked(n_ranks), lengths_out(n_ranks);
  std::vector<std::vector<double>> values_out(n_ranks);
  Fetched in = {std::vector<std::vector<int>>(n_ranks), std::vector<std::vector<double>>(n_ranks)};
  for (int r = 0; r < n_ranks; ++r) {
    asked[r].resize(n_asked[r]);
    messages.receive(asked[r], MPI_INT, r, tag_rows);
    messages.send(wanted[r], MPI_INT, r, tag_rows);
  }
  messages.wait();
  for (int r = 0; r < n_ranks; ++r) {
    for (const int row : asked[r]) {
      lengths_out[r].push_back(static_cast<int>(kept.length(row)));
      values_out[r].insert(values_out[r].end(), kept[row], kept[row] + kept.length(row));
    }
    in.lengths[r].resize(n_wanted[r]);
    messages.receive(in.lengths[r], MPI_INT, r, tag_lengths);
    messages.send(lengths_out[r], MPI_INT, r, tag_lengths);
  }
  messages.wait();
  for (int r = 0; r < n_ranks; ++r) {
    in.values[r].resize(
        std::accumulate(in.lengths[r].begin(), in.lengths[r].end(), std::size_t(0)));
    messages.receive(in.values[r], MPI_DOUBLE, r, tag_values);
    messages.send(values_out[r], MPI_DOUBLE, r, tag_values);
  }
  messages.wait();
  return in;
}

} // namespace

RowViews fetch_rows(const Rows &kept, const std::vector<Origin> &origins, MPI_Comm comm)
{
  int rank, n_ranks;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &n_ranks);
  std::vector<std::vector<int>> wanted(n_ranks);
  for (const Origin &origin : origins)
    if (origin.rank >= 0 && origin.rank != rank)
      wanted[origin.rank].push_back(origin.row);
  Fetched in = fetch(kept, wanted, comm);

  RowViews rows;
  rows.reserve(origins.size());
  std::vector<std::size_t> next_row(n_ranks, 0);
  std::vector<const double *> next_value(n_ranks);
  for (int r = 0; r < n_ranks; ++r)
    next_value[r] = rows.own(std::move(in.values[r])).data();
  for (const Origin &origin : origins) {
    const int r = origin.rank;
    if (r == rank)
      rows.add(kept[origin.row], kept.length(origin.row));
    else if (r >= 0) {
      const int n = in.lengths[r][next_row[r]++];
      rows.add(next_value[r], n);
      next_value[r] += n;
    } else
      rows.add(nullptr, 0);
  }
  return rows;
}

} // namespace eunoe
