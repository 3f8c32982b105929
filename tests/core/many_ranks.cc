// What a rank has to do with the others, for as many ranks as there will never be here: the ways of
// rows that are sorted over all ranks, their shares, and the parts of a box. Counted, not timed.

#include <eunoe/core/box_parts.h>
#include <eunoe/core/key_ranges.h>
#include <eunoe/core/random.h>

#include "../tests.h"

#include <cmath>
#include <numeric>
#include <set>

using namespace test;
using namespace eunoe;

namespace {

constexpr int many[] = {64, 4096, 65536};

void check_routes()
{
  bool all_arrive = true, are_few = true;
  for (const int n : {1, 2, 3, 5, 7, 10, 64, 4096, 65535, 65536, 65537}) {
    const SquareRoutes routes(n);
    const int width = static_cast<int>(std::ceil(std::sqrt(n)));
    // Some ranks, the first and the last among them.
    for (int from = 0; from < n;
         from += from + 1 < n ? std::min(std::max(1, n / 7), n - 1 - from) : 1) {
      std::set<int> first_partners;
      for (int to = 0; to < n; ++to) {
        const int via = routes.via(from, to);
        const bool first_in_row = via / width == from / width && via % width == to % width;
        const bool first_in_column = via / width == to / width && via % width == from % width;
        // Then those that a rank hands on to stand in its row or column, too.
        all_arrive = all_arrive && via >= 0 && via < n && (first_in_row || first_in_column);
        first_partners.insert(via);
      }
      are_few = are_few && static_cast<int>(first_partners.size()) <= 2 * width;
    }
  }
  check("every rank is reached", all_arrive);
  check("partners are two rows", are_few);
}

/// Most keys of a rank over the mean.
double unevenness(const std::vector<std::uint64_t> &counts, const std::uint32_t largest,
                  const int n_ranks)
{
  const KeyRanges ranges(0, largest, counts, n_ranks);
  const std::uint32_t width = largest / KeyRanges::n_parts + 1;
  std::vector<std::uint64_t> of_rank(n_ranks, 0);
  int last = 0;
  bool ascend = true;
  for (int part = 0; part < KeyRanges::n_parts; ++part) {
    const int rank = ranges.rank(static_cast<std::uint32_t>(part) * width);
    of_rank[rank] += counts[part];
    ascend = ascend && rank >= last;
    last = rank;
  }
  check("ranks ascend with the keys, " + std::to_string(n_ranks), ascend);
  const std::uint64_t all = std::accumulate(counts.begin(), counts.end(), std::uint64_t(0));
  return static_cast<double>(*std::max_element(of_rank.begin(), of_rank.end())) * n_ranks /
         static_cast<double>(all);
}

void check_ranges()
{
  // A hundred million ids, and the same after a half of the first third has left.
  constexpr std::uint32_t largest = 100000000;
  std::vector<std::uint64_t> dense(KeyRanges::n_parts, largest / KeyRanges::n_parts);
  std::vector<std::uint64_t> thinned = dense;
  for (int part = 0; part < KeyRanges::n_parts / 3; ++part)
    thinned[part] /= 2;
  for (const int n : many) {
    check("equal shares, " + std::to_string(n), unevenness(dense, largest, n) < 1.2);
    check("after some have left, " + std::to_string(n), unevenness(thinned, largest, n) < 2.);
  }
}

void check_parts()
{
  const PeriodicBox box = {{0., 0., 3.}, {0., 0., -1.}};
  const Vec3 lower = {0., 0., -1.}, upper = {10., 2., 2.};
  const auto place = [&](const std::uint32_t k) {
    Vec3 x;
    for (unsigned int d = 0; d < 3; ++d)
      x[d] = lower[d] + (upper[d] - lower[d]) * uniform(1, Draw::packing, k, d);
    // Denser to the left.
    x.x = 0.1 * x.x * x.x;
    return x;
  };
  for (const int n : many) {
    std::vector<Vec3> sample;
    for (std::uint32_t k = 0; k < BoxParts::sample_size(n); ++k)
      sample.push_back(place(k));
    const BoxParts parts(lower, upper, box, sample, n);
    const std::string ranks = ", " + std::to_string(n);
    std::vector<int> number(n, 0);
    for (std::uint32_t k = 0; k < 64 * static_cast<std::uint32_t>(n); ++k)
      ++number[parts.at(place(1000000000u + k))];
    // Of many thousand parts a few are far from the mean.
    check("no part has much more" + ranks,
          *std::max_element(number.begin(), number.end()) < 4 * 64);
    // Of the size of a part.
    const double reach = 0.3 * std::cbrt(60. / n);
    bool all_found = true;
    std::size_t most = 0;
    std::vector<int> near;
    for (std::uint32_t k = 0; k < 500; ++k) {
      const Vec3 x = place(2000000000u + k);
      parts.near(x, reach, near);
      most = std::max(most, near.size());
      for (unsigned int t = 0; t < 20; ++t) {
        Vec3 y = x;
        for (unsigned int d = 0; d < 3; ++d)
          y[d] += reach * (2. * uniform(2, Draw::packing, k, 3 * t + d) - 1.);
        all_found = all_found && std::binary_search(near.begin(), near.end(), parts.at(y));
      }
    }
    check("all parts around are found" + ranks, all_found);
    // Where places are dense, parts are smaller than the reach.
    check("they are few" + ranks, most < 100);
  }
}

} // namespace

EUNOE_TEST()
{
  check_routes();
  check_ranges();
  check_parts();
}
