// Rows in the order of their keys over all ranks.

#include <eunoe/core/key_ranges.h>
#include <eunoe/core/rows.h>
#include <eunoe/core/sparse_exchange.h>

#include <algorithm>

namespace eunoe {

namespace {

/// Rows on their way to a rank.
struct Parcel
{
  std::vector<std::uint32_t> keys, lengths;
  std::vector<double> values;

  void add(const std::uint32_t key, const double *row, const std::size_t length)
  {
    keys.push_back(key);
    lengths.push_back(static_cast<std::uint32_t>(length));
    values.insert(values.end(), row, row + length);
  }
};

/// What stands in the parcels, each part by rank, as it is sent.
struct Parcels
{
  std::map<int, std::vector<std::uint32_t>> keys, lengths;
  std::map<int, std::vector<double>> values;
};

std::vector<Parcel> exchange(std::map<int, Parcel> &&out, MPI_Comm comm)
{
  Parcels parts;
  for (auto &[rank, parcel] : out) {
    parts.keys[rank] = std::move(parcel.keys);
    parts.lengths[rank] = std::move(parcel.lengths);
    if (!parcel.values.empty())
      parts.values[rank] = std::move(parcel.values);
  }
  out.clear();
  std::map<int, Parcel> in;
  for (auto &[rank, list] : exchange_lists(std::move(parts.keys), comm))
    in[rank].keys = std::move(list);
  for (auto &[rank, list] : exchange_lists(std::move(parts.lengths), comm))
    in[rank].lengths = std::move(list);
  for (auto &[rank, list] : exchange_lists(std::move(parts.values), comm))
    in[rank].values = std::move(list);
  std::vector<Parcel> all;
  for (auto &[rank, parcel] : in)
    all.push_back(std::move(parcel));
  return all;
}

/// Calls `action(key, row, length)` for the rows of parcels.
template <typename Action>
void for_each_row(const std::vector<Parcel> &parcels, const Action &action)
{
  for (const Parcel &parcel : parcels) {
    const double *row = parcel.values.data();
    for (std::size_t k = 0; k < parcel.keys.size(); ++k) {
      action(parcel.keys[k], row, parcel.lengths[k]);
      row += parcel.lengths[k];
    }
  }
}

struct KeyedView
{
  std::uint32_t key;
  const double *begin;
  std::size_t length;
};

} // namespace

SortedRows sort_rows(const std::vector<std::uint32_t> &keys, Rows &&rows, MPI_Comm comm,
                     const int most_direct)
{
  int rank, n_ranks;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &n_ranks);
  const KeyRanges ranges(keys, comm);
  const SquareRoutes routes(n_ranks);
  const bool is_direct = n_ranks <= most_direct;
  // What stays here is not copied.
  std::vector<KeyedView> views;
  std::map<int, Parcel> out;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const int to = ranges.rank(keys[k]);
    if (to == rank)
      views.push_back({keys[k], rows[k], rows.length(k)});
    else
      out[is_direct ? to : routes.via(rank, to)].add(keys[k], rows[k], rows.length(k));
  }
  std::vector<Parcel> in = exchange(std::move(out), comm);
  if (!is_direct) {
    std::map<int, Parcel> further;
    for_each_row(in, [&](const std::uint32_t key, const double *row, const std::size_t length) {
      further[ranges.rank(key)].add(key, row, length);
    });
    in = exchange(std::move(further), comm);
  }
  for_each_row(in, [&](const std::uint32_t key, const double *row, const std::size_t length) {
    views.push_back({key, row, length});
  });
  std::sort(views.begin(), views.end(),
            [](const KeyedView &a, const KeyedView &b) { return a.key < b.key; });

  SortedRows sorted;
  sorted.keys.reserve(views.size());
  sorted.rows.reserve(views.size());
  for (const KeyedView &view : views) {
    sorted.keys.push_back(view.key);
    sorted.rows.add(view.begin, view.length);
  }
  // Moving keeps the values where they are.
  if (views.empty())
    return sorted;
  sorted.rows.own(std::move(rows.values));
  for (Parcel &parcel : in)
    sorted.rows.own(std::move(parcel.values));
  return sorted;
}

} // namespace eunoe
