#include <eunoe/core/rows.h>
#include <eunoe/core/sparse_exchange.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <numeric>

namespace eunoe {

namespace {

constexpr int tag_rows = 301, tag_lengths = 302, tag_values = 303, tag_keys = 304;

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

/// Asks ranks for rows that they kept: first how many, then which, then their contents.
/// @param wanted by rank
std::map<int, Fetched> fetch(const Rows &kept, const std::map<int, std::vector<int>> &wanted,
                             MPI_Comm comm)
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
      answer.lengths.push_back(static_cast<int>(kept.length(row)));
      answer.values.insert(answer.values.end(), kept[row], kept[row] + kept.length(row));
    }
    messages.send(answer.lengths, MPI_INT, rank, tag_lengths);
  }
  for (const auto &[rank, n] : n_wanted) {
    in[rank].lengths.resize(n);
    messages.receive(in[rank].lengths, MPI_INT, rank, tag_lengths);
  }
  messages.wait();
  for (const auto &[rank, answer] : out)
    messages.send(answer.values, MPI_DOUBLE, rank, tag_values);
  for (auto &[rank, answer] : in) {
    answer.values.resize(
        std::accumulate(answer.lengths.begin(), answer.lengths.end(), std::size_t(0)));
    messages.receive(answer.values, MPI_DOUBLE, rank, tag_values);
  }
  messages.wait();
  return in;
}

} // namespace

RowViews fetch_rows(const Rows &kept, const std::vector<Origin> &origins, MPI_Comm comm)
{
  int rank;
  MPI_Comm_rank(comm, &rank);
  std::map<int, std::vector<int>> wanted;
  for (const Origin &origin : origins)
    if (origin.rank >= 0 && origin.rank != rank)
      wanted[origin.rank].push_back(origin.row);

  RowViews rows;
  rows.reserve(origins.size());
  struct Next
  {
    std::vector<int> lengths;
    const double *values;
    std::size_t row;
  };
  std::map<int, Next> next;
  for (auto &[from, answer] : fetch(kept, wanted, comm))
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

namespace {

/// The rank that gets each key: the range of keys is cut where the ranks have equal numbers, as
/// nearly as equal parts of the range allow.
class KeyRanges
{
public:
  KeyRanges(const std::vector<std::uint32_t> &keys, MPI_Comm comm) : ranks(n_parts)
  {
    std::uint32_t largest = 0;
    for (const std::uint32_t key : keys) {
      smallest = std::min(smallest, key);
      largest = std::max(largest, key);
    }
    MPI_Allreduce(MPI_IN_PLACE, &smallest, 1, MPI_UINT32_T, MPI_MIN, comm);
    MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_UINT32_T, MPI_MAX, comm);
    width = largest < smallest ? 1 : (largest - smallest) / n_parts + 1;
    std::vector<std::uint64_t> counts(n_parts, 0);
    for (const std::uint32_t key : keys)
      ++counts[part(key)];
    MPI_Allreduce(MPI_IN_PLACE, counts.data(), n_parts, MPI_UINT64_T, MPI_SUM, comm);
    int n_ranks;
    MPI_Comm_size(comm, &n_ranks);
    const std::uint64_t n = std::accumulate(counts.begin(), counts.end(), std::uint64_t(0));
    std::uint64_t before = 0;
    for (int k = 0; k < n_parts; ++k) {
      // A part goes where its first key belongs.
      const std::uint64_t rank = n == 0 ? 0 : before * static_cast<std::uint64_t>(n_ranks) / n;
      ranks[k] = static_cast<int>(std::min<std::uint64_t>(n_ranks - 1, rank));
      before += counts[k];
    }
  }

  int rank(const std::uint32_t key) const { return ranks[part(key)]; }

private:
  std::uint32_t part(const std::uint32_t key) const { return (key - smallest) / width; }

  static constexpr int n_parts = 1 << 16;
  std::uint32_t smallest = std::numeric_limits<std::uint32_t>::max(), width;
  std::vector<int> ranks;
};

/// Rows on their way to or from a rank.
struct Parcel
{
  std::vector<std::uint32_t> keys;
  std::vector<int> lengths;
  std::vector<double> values;

  void add(const std::uint32_t key, const double *row, const std::size_t length)
  {
    keys.push_back(key);
    lengths.push_back(static_cast<int>(length));
    values.insert(values.end(), row, row + length);
  }
};

/// Exchanges a parcel with every rank; what a rank has for itself stays.
std::vector<Parcel> exchange(std::vector<Parcel> &&out, MPI_Comm comm)
{
  int rank, n_ranks;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &n_ranks);
  std::vector<std::array<int, 2>> sent(n_ranks), received(n_ranks);
  for (int r = 0; r < n_ranks; ++r)
    if (r != rank)
      sent[r] = {{static_cast<int>(out[r].keys.size()), static_cast<int>(out[r].values.size())}};
  MPI_Alltoall(sent.data(), 2, MPI_INT, received.data(), 2, MPI_INT, comm);
  std::vector<Parcel> in(n_ranks);
  Messages messages(comm);
  for (int r = 0; r < n_ranks; ++r) {
    if (r == rank)
      continue;
    in[r].keys.resize(received[r][0]);
    in[r].lengths.resize(received[r][0]);
    in[r].values.resize(received[r][1]);
    messages.receive(in[r].keys, MPI_UINT32_T, r, tag_keys);
    messages.receive(in[r].lengths, MPI_INT, r, tag_lengths);
    messages.receive(in[r].values, MPI_DOUBLE, r, tag_values);
    messages.send(out[r].keys, MPI_UINT32_T, r, tag_keys);
    messages.send(out[r].lengths, MPI_INT, r, tag_lengths);
    messages.send(out[r].values, MPI_DOUBLE, r, tag_values);
  }
  messages.wait();
  in[rank] = std::move(out[rank]);
  return in;
}

} // namespace

KeyedRows sort_rows(const std::vector<std::uint32_t> &keys, const Rows &rows, MPI_Comm comm)
{
  int n_ranks;
  MPI_Comm_size(comm, &n_ranks);
  const KeyRanges ranges(keys, comm);
  std::vector<Parcel> out(n_ranks);
  for (std::size_t k = 0; k < keys.size(); ++k)
    out[ranges.rank(keys[k])].add(keys[k], rows[k], rows.length(k));
  const std::vector<Parcel> in = exchange(std::move(out), comm);

  struct Place
  {
    std::uint32_t key;
    const double *begin;
    std::size_t length;
  };
  std::vector<Place> places;
  for (const Parcel &parcel : in) {
    const double *row = parcel.values.data();
    for (std::size_t k = 0; k < parcel.keys.size(); ++k) {
      const auto length = static_cast<std::size_t>(parcel.lengths[k]);
      places.push_back({parcel.keys[k], row, length});
      row += length;
    }
  }
  std::sort(places.begin(), places.end(),
            [](const Place &a, const Place &b) { return a.key < b.key; });
  KeyedRows sorted;
  for (const Place &place : places) {
    sorted.keys.push_back(place.key);
    sorted.rows.append(place.begin, place.begin + place.length);
  }
  return sorted;
}

} // namespace eunoe
