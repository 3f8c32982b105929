// Rows are brought into the order of their keys over all ranks, whole and shared out evenly.
// Reference: each row follows from its key.

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
Result sorted(const std::vector<std::uint32_t> &keys)
{
  std::vector<std::uint32_t> mine;
  Rows rows;
  for (std::size_t k = 0; k < keys.size(); ++k)
    if (static_cast<int>(k % n_ranks) == rank) {
      const std::vector<double> row = row_of(keys[k]);
      mine.push_back(keys[k]);
      rows.append(row.data(), row.data() + row.size());
    }
  const KeyedRows found = sort_rows(mine, rows, MPI_COMM_WORLD);

  Result result;
  for (std::size_t k = 0; k < found.keys.size(); ++k) {
    result.ascend = result.ascend && (k == 0 || found.keys[k - 1] < found.keys[k]);
    const std::vector<double> row(found.rows[k], found.rows[k] + found.rows.length(k));
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
                const std::uint64_t unevenness)
{
  const Result result = sorted(keys);
  const double sum = std::accumulate(keys.begin(), keys.end(), 0.);
  check(name + ", all there", result.n == keys.size() && result.sum == sum);
  check(name + ", in order", result.ascend);
  check(name + ", whole", result.are_whole);
  check(name + ", evenly", result.most <= keys.size() / n_ranks + unevenness);
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
}
