#include <eunoe/core/message_tags.h>
#include <eunoe/core/rows.h>
#include <eunoe/core/sparse_exchange.h>

#include <map>
#include <numeric>

namespace eunoe {

namespace {

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

/// Rows that another rank kept, in the order in which they were asked for.
struct Fetched
{
  std::vector<int> lengths;
  std::vector<double> values;
};

/// The rows that are kept elsewhere, by rank.
std::map<int, std::vector<int>> wanted_from_others(const std::vector<Origin> &origins,
                                                   MPI_Comm comm)
{
  int rank;
  MPI_Comm_rank(comm, &rank);
  std::map<int, std::vector<int>> wanted;
  for (const Origin &origin : origins)
    if (origin.rank >= 0 && origin.rank != rank)
      wanted[origin.rank].push_back(origin.row);
  return wanted;
}

/// Asks ranks for rows that they kept: first how many, then which, then their contents.
/// @param wanted by rank
/// @param pack appends a row of this rank
std::map<int, Fetched> fetch(
    const std::map<int, std::vector<int>> &wanted,
    const std::function<void(std::int32_t row, std::vector<double> &values)> &pack, MPI_Comm comm)
{
  std::map<int, int> n_wanted;
  for (const auto &[rank, list] : wanted)
    n_wanted[rank] = static_cast<int>(list.size());

  Messages messages(comm);
  std::map<int, std::vector<int>> asked;
  for (const auto &[rank, n] : numbers_from(n_wanted, comm)) {
    asked[rank].resize(n);
    messages.receive(asked[rank], MPI_INT, rank, tag_rows);
  }
  for (const auto &[rank, list] : wanted)
    messages.send(list, MPI_INT, rank, tag_rows);
  messages.wait();

  std::map<int, Fetched> out, in;
  for (const auto &[rank, list] : asked) {
    Fetched &answer = out[rank];
    for (const int row : list) {
      const std::size_t before = answer.values.size();
      pack(row, answer.values);
      answer.lengths.push_back(static_cast<int>(answer.values.size() - before));
    }
    messages.send(answer.lengths, MPI_INT, rank, tag_row_lengths);
  }
  for (const auto &[rank, n] : n_wanted) {
    in[rank].lengths.resize(n);
    messages.receive(in[rank].lengths, MPI_INT, rank, tag_row_lengths);
  }
  messages.wait();
  for (const auto &[rank, answer] : out)
    messages.send(answer.values, MPI_DOUBLE, rank, tag_row_values);
  for (auto &[rank, answer] : in) {
    answer.values.resize(
        std::accumulate(answer.lengths.begin(), answer.lengths.end(), std::size_t(0)));
    messages.receive(answer.values, MPI_DOUBLE, rank, tag_row_values);
  }
  messages.wait();
  return in;
}

} // namespace

RowViews fetch_rows(const Rows &kept, const std::vector<Origin> &origins, MPI_Comm comm)
{
  int rank;
  MPI_Comm_rank(comm, &rank);
  const auto pack = [&kept](const std::int32_t row, std::vector<double> &values) {
    values.insert(values.end(), kept[row], kept[row] + kept.length(row));
  };

  RowViews rows;
  rows.reserve(origins.size());
  struct Next
  {
    std::vector<int> lengths;
    const double *values;
    std::size_t row;
  };
  std::map<int, Next> next;
  for (auto &[from, answer] : fetch(wanted_from_others(origins, comm), pack, comm))
    next[from] = {answer.lengths, rows.own(std::move(answer.values)).data(), 0};
  for (const Origin &origin : origins) {
    if (origin.rank == rank)
      rows.add(kept[origin.row], kept.length(origin.row));
    else if (origin.rank >= 0) {
      Next &place = next[origin.rank];
      const int n = place.lengths[place.row++];
      rows.add(place.values, n);
      place.values += n;
    } else
      rows.add(nullptr, 0);
  }
  return rows;
}

std::vector<double> fetch_foreign(
    const std::vector<Origin> &origins, const std::size_t n_values,
    const std::function<void(std::int32_t row, std::vector<double> &values)> &pack, MPI_Comm comm)
{
  const std::map<int, Fetched> fetched = fetch(wanted_from_others(origins, comm), pack, comm);
  std::map<int, const double *> next;
  for (const auto &[from, answer] : fetched)
    next[from] = answer.values.data();
  std::vector<double> all;
  all.reserve(n_values * origins.size());
  for (const Origin &origin : origins) {
    const double *&row = next.at(origin.rank);
    all.insert(all.end(), row, row + n_values);
    row += n_values;
  }
  return all;
}

} // namespace eunoe
