// Rows are brought into the order of their keys over all ranks, whole and shared out evenly.
// Reference: each row follows from its key.

#include <eunoe/core/key_ranges.h>
#include <eunoe/core/rows.h>

#include "../tests.h"

#include <numeric>

using namespace test;
using namespace eunoe;

namespace {

int rank, n_ranks;

/// Length 0 to 4, with numbers of the key alone.
std::vector<double> row_of(const std::uint32_t key)
{
  std::vector<double> row(key % 5);
  std::iota(row.begin(), row.end(), 0.5 * key);
  return row;
}

struct Result
{
  bool ascend = true, are_whole = true;
  std::uint64_t n = 0, most = 0;
  double sum = 0.; ///< of all keys
};

/// @param keys of all ranks; every rank keeps those at its turn
Result sorted(const std::vector<std::uint32_t> &keys, const int most_direct)
{
  std::vector<std::uint32_t> mine;
  Rows rows;
  for (std::size_t k = 0; k < keys.size(); ++k)
    if (static_cast<int>(k % n_ranks) == rank) {
      const std::vector<double> row = row_of(keys[k]);
      mine.push_back(keys[k]);
      rows.append(row.data(), row.data() + row.size());
    }
  const SortedRows found = sort_rows(mine, std::move(rows), MPI_COMM_WORLD, most_direct);

  Result result;
  for (std::size_t k = 0; k < found.keys.size(); ++k) {
    result.ascend = result.ascend && (k == 0 || found.keys[k - 1] < found.keys[k]);
    const std::vector<double> row(found.rows[k], found.rows.end(k));
    result.are_whole = result.are_whole && row == row_of(found.keys[k]);
    result.sum += found.keys[k];
  }
  // The last key so far is below those of the ranks behind.
  double last = found.keys.empty() ? -1. : found.keys.back(), before = -1.;
  MPI_Scan(&last, &before, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  result.ascend = result.ascend && (found.keys.empty() || before == last);
  result.n = result.most = found.keys.size();
  MPI_Allreduce(MPI_IN_PLACE, &result.n, 1, MPI_UINT64_T, MPI_SUM, MPI_COMM_WORLD);
  MPI_Allreduce(MPI_IN_PLACE, &result.most, 1, MPI_UINT64_T, MPI_MAX, MPI_COMM_WORLD);
  MPI_Allreduce(MPI_IN_PLACE, &result.sum, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  int ok[2] = {result.ascend ? 1 : 0, result.are_whole ? 1 : 0};
  MPI_Allreduce(MPI_IN_PLACE, ok, 2, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  result.ascend = ok[0] != 0;
  result.are_whole = ok[1] != 0;
  return result;
}

void check_keys(const std::string &name, const std::vector<std::uint32_t> &keys,
                const std::uint64_t unevenness, const int most_direct = 256)
{
  const Result result = sorted(keys, most_direct);
  const double sum = std::accumulate(keys.begin(), keys.end(), 0.);
  check(name + ", all there", result.n == keys.size() && result.sum == sum);
  check(name + ", in order", result.ascend);
  check(name + ", whole", result.are_whole);
  check(name + ", evenly", result.most <= keys.size() / n_ranks + unevenness);
}

/// Each rank asks for some keys of others, and for some that are none.
void check_places(const std::vector<std::uint32_t> &keys)
{
  std::vector<std::uint32_t> mine, asked, ordered = keys;
  for (std::size_t k = 0; k < keys.size(); ++k)
    if (static_cast<int>(k % n_ranks) == rank)
      mine.push_back(7 + 3 * keys[k]);
  std::sort(ordered.begin(), ordered.end());
  bool ok = true;
  for (const std::uint32_t beyond : {0u, 6u, 8u, 4000000000u})
    asked.push_back(beyond);
  for (std::size_t k = static_cast<std::size_t>(rank); k < ordered.size(); k += 11)
    asked.push_back(7 + 3 * ordered[k]);
  const std::vector<std::int64_t> places = places_in_order(mine, asked, MPI_COMM_WORLD);
  for (std::size_t k = 0; k < asked.size(); ++k)
    ok = ok && places[k] == (k < 4 ? -1 : static_cast<std::int64_t>(rank + 11 * (k - 4)));
  int all_ok = ok ? 1 : 0;
  MPI_Allreduce(MPI_IN_PLACE, &all_ok, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  check("places in the order", all_ok != 0);
}

} // namespace

EUNOE_MPI_TEST()
{
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
  // 7919 is prime, so the keys are all different.
  std::vector<std::uint32_t> spread, few, high, with_a_gap;
  for (std::uint32_t k = 0; k < 7919; ++k)
    spread.push_back(k * 3571u % 7919u);
  for (std::uint32_t k = 0; k < 1000; ++k) {
    high.push_back(4000000000u + k * 389u % 1009u);
    with_a_gap.push_back(k % 2 == 0 ? k : 3000000000u + 60000u * k);
  }
  few = {17};
  check_keys("numbers without gaps", spread, 2);
  check_keys("high numbers", high, 2);
  check_keys("a gap", with_a_gap, 500);
  check_keys("a single row", few, 1);
  check_keys("none", {}, 0);
  // As with many ranks, over one between.
  check_keys("in two steps", spread, 2, 1);
  check_places(spread);
}
