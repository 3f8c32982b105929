#include <eunoe/core/key_ranges.h>
#include <eunoe/core/sparse_exchange.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

namespace eunoe {

KeyRanges::KeyRanges(const std::vector<std::uint32_t> &keys, MPI_Comm comm)
{
  std::uint32_t largest = 0;
  for (const std::uint32_t key : keys) {
    smallest = std::min(smallest, key);
    largest = std::max(largest, key);
  }
  MPI_Allreduce(MPI_IN_PLACE, &smallest, 1, MPI_UINT32_T, MPI_MIN, comm);
  MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_UINT32_T, MPI_MAX, comm);
  set_width(largest);
  std::vector<std::uint64_t> counts(n_parts, 0);
  for (const std::uint32_t key : keys)
    ++counts[part(key)];
  MPI_Allreduce(MPI_IN_PLACE, counts.data(), n_parts, MPI_UINT64_T, MPI_SUM, comm);
  int n_ranks;
  MPI_Comm_size(comm, &n_ranks);
  share_out(counts, n_ranks);
}

KeyRanges::KeyRanges(const std::uint32_t smallest, const std::uint32_t largest,
                     const std::vector<std::uint64_t> &counts, const int n_ranks)
    : smallest(smallest)
{
  set_width(largest);
  share_out(counts, n_ranks);
}

void KeyRanges::set_width(const std::uint32_t largest)
{
  width = largest < smallest ? 1 : (largest - smallest) / n_parts + 1;
}

void KeyRanges::share_out(const std::vector<std::uint64_t> &counts, const int n_ranks)
{
  ranks.resize(n_parts);
  const std::uint64_t n = std::accumulate(counts.begin(), counts.end(), std::uint64_t(0));
  std::uint64_t before = 0;
  for (int k = 0; k < n_parts; ++k) {
    // A part goes where its first key belongs.
    const std::uint64_t rank = n == 0 ? 0 : before * static_cast<std::uint64_t>(n_ranks) / n;
    ranks[k] = static_cast<int>(std::min<std::uint64_t>(n_ranks - 1, rank));
    before += counts[k];
  }
}

SquareRoutes::SquareRoutes(const int n_ranks)
    : n_ranks(n_ranks), width(static_cast<int>(std::ceil(std::sqrt(n_ranks))))
{
}

int SquareRoutes::via(const int from, const int to) const
{
  const int in_row = from / width * width + to % width;
  // The last row may be shorter; then the message goes first within the column.
  return in_row < n_ranks ? in_row : to / width * width + from % width;
}

std::vector<std::int64_t> places_in_order(const std::vector<std::uint32_t> &keys,
                                          const std::vector<std::uint32_t> &asked, MPI_Comm comm)
{
  using Lists = std::map<int, std::vector<std::uint32_t>>;
  const KeyRanges ranges(keys, comm);
  Lists out;
  for (const std::uint32_t key : keys)
    out[ranges.rank(key)].push_back(key);
  std::vector<std::uint32_t> mine;
  for (const auto &[from, list] : exchange_lists(std::move(out), comm))
    mine.insert(mine.end(), list.begin(), list.end());
  std::sort(mine.begin(), mine.end());
  std::int64_t n = static_cast<std::int64_t>(mine.size()), end = 0;
  MPI_Scan(&n, &end, 1, MPI_INT64_T, MPI_SUM, comm);

  Lists questions;
  for (const std::uint32_t key : asked)
    questions[ranges.rank(key)].push_back(key);
  std::map<int, std::vector<std::int64_t>> answers;
  for (const auto &[from, list] : exchange_lists(Lists(questions), comm))
    for (const std::uint32_t key : list) {
      const auto found = std::lower_bound(mine.begin(), mine.end(), key);
      answers[from].push_back(
          found != mine.end() && *found == key ? end - n + (found - mine.begin()) : -1);
    }
  std::unordered_map<std::uint32_t, std::int64_t> places;
  for (const auto &[from, list] : exchange_lists(std::move(answers), comm))
    for (std::size_t k = 0; k < list.size(); ++k)
      places[questions.at(from)[k]] = list[k];
  std::vector<std::int64_t> result;
  result.reserve(asked.size());
  for (const std::uint32_t key : asked)
    result.push_back(places.at(key));
  return result;
}

} // namespace eunoe
