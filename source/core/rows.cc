#include <eunoe/core/rows.h>

#include <numeric>

namespace eunoe {

RowViews fetch_rows(const Rows &kept, const std::vector<Origin> &origins, MPI_Comm comm)
{
  int rank, n_ranks;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &n_ranks);

  // Ask every rank for the rows that it kept: first how many, then which, then their contents.
  std::vector<std::vector<int>> wanted(n_ranks);
  for (const Origin &origin : origins)
    if (origin.rank >= 0 && origin.rank != rank)
      wanted[origin.rank].push_back(origin.row);
  std::vector<int> n_wanted(n_ranks), n_asked(n_ranks);
  for (int r = 0; r < n_ranks; ++r)
    n_wanted[r] = static_cast<int>(wanted[r].size());
  MPI_Alltoall(n_wanted.data(), 1, MPI_INT, n_asked.data(), 1, MPI_INT, comm);

  constexpr int tag_rows = 301, tag_lengths = 302, tag_values = 303;
  std::vector<MPI_Request> requests;
  const auto wait = [&requests]() {
    MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
    requests.clear();
  };
  const auto send = [&](const void *data, std::size_t n, MPI_Datatype type, int to, int tag) {
    requests.emplace_back();
    MPI_Isend(data, static_cast<int>(n), type, to, tag, comm, &requests.back());
  };
  const auto receive = [&](void *data, std::size_t n, MPI_Datatype type, int from, int tag) {
    requests.emplace_back();
    MPI_Irecv(data, static_cast<int>(n), type, from, tag, comm, &requests.back());
  };

  std::vector<std::vector<int>> asked(n_ranks), lengths_out(n_ranks), lengths_in(n_ranks);
  std::vector<std::vector<double>> values_out(n_ranks), values_in(n_ranks);
  for (int r = 0; r < n_ranks; ++r) {
    asked[r].resize(n_asked[r]);
    if (n_asked[r] > 0)
      receive(asked[r].data(), n_asked[r], MPI_INT, r, tag_rows);
    if (n_wanted[r] > 0)
      send(wanted[r].data(), n_wanted[r], MPI_INT, r, tag_rows);
  }
  wait();
  for (int r = 0; r < n_ranks; ++r) {
    for (const int row : asked[r]) {
      lengths_out[r].push_back(static_cast<int>(kept.length(row)));
      values_out[r].insert(values_out[r].end(), kept[row], kept[row] + kept.length(row));
    }
    lengths_in[r].resize(n_wanted[r]);
    if (n_wanted[r] > 0)
      receive(lengths_in[r].data(), n_wanted[r], MPI_INT, r, tag_lengths);
    if (n_asked[r] > 0)
      send(lengths_out[r].data(), n_asked[r], MPI_INT, r, tag_lengths);
  }
  wait();
  for (int r = 0; r < n_ranks; ++r) {
    values_in[r].resize(
        std::accumulate(lengths_in[r].begin(), lengths_in[r].end(), std::size_t(0)));
    if (!values_in[r].empty())
      receive(values_in[r].data(), values_in[r].size(), MPI_DOUBLE, r, tag_values);
    if (!values_out[r].empty())
      send(values_out[r].data(), values_out[r].size(), MPI_DOUBLE, r, tag_values);
  }
  wait();

  RowViews rows;
  rows.reserve(origins.size());
  std::vector<std::size_t> next_row(n_ranks, 0);
  std::vector<const double *> next_value(n_ranks);
  for (int r = 0; r < n_ranks; ++r)
    next_value[r] = rows.own(std::move(values_in[r])).data();
  for (const Origin &origin : origins) {
    const int r = origin.rank;
    if (r == rank)
      rows.add(kept[origin.row], kept.length(origin.row));
    else if (r >= 0) {
      const int n = lengths_in[r][next_row[r]++];
      rows.add(next_value[r], n);
      next_value[r] += n;
    } else
      rows.add(nullptr, 0);
  }
  return rows;
}

} // namespace eunoe
