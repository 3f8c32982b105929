// The owners of cells as they would be on many ranks: metadata of ranks that do not exist. Counted
// is what a rank has to look at, not timed. Reference: the owner of every cell around, found by its
// number on the curve.

#include <eunoe/engine/curve_owners.h>

#include "../tests.h"

#include <cmath>
#include <set>

using namespace test;
using namespace eunoe;

namespace {

using Place = CurveOwners::Place;

/// A lattice whose curve is cut into uneven pieces, some of them empty.
class FakeRanks
{
public:
  FakeRanks(const Place &n_coarse, const unsigned int n_levels, const int n_ranks)
      : n_coarse(n_coarse), n_levels(n_levels),
        n_cells(static_cast<std::uint64_t>(n_coarse[0]) * n_coarse[1] * n_coarse[2] << 3 * n_levels)
  {
    for (int r = 0; r < n_ranks; ++r) {
      const std::uint64_t even = n_cells / n_ranks * r;
      // Some pieces are smaller than others, and every 29th rank has none.
      starts.push_back(r % 29 == 28 ? starts.back() : even + (r == 0 ? 0 : even / 7 * 3 % 97));
    }
    for (int r = n_ranks - 1; r-- > 0;)
      if (r % 29 == 28)
        starts[r] = starts[r + 1];
  }

  int size() const { return static_cast<int>(starts.size()); }

  CurveOwners owners(std::uint64_t &looks) const
  {
    return {n_coarse,
            n_levels,
            {{false, false, true}},
            [this](const int cell) { return tree(cell); },
            size(),
            [this, &looks](const int rank) {
              ++looks;
              return CurveOwners::Position(static_cast<std::int64_t>(starts[rank] >> 3 * n_levels),
                                           starts[rank] & ((std::uint64_t(1) << 3 * n_levels) - 1));
            }};
  }

  /// Coarse cells in another order than their numbers have, as deal.II gives p4est.
  std::int64_t tree(const int cell) const
  {
    const int n = n_coarse[0] * n_coarse[1] * n_coarse[2];
    return n - 1 - cell;
  }

  int owner(const std::uint64_t number) const
  {
    return static_cast<int>(std::upper_bound(starts.begin(), starts.end(), number) -
                            starts.begin()) -
           1;
  }

  /// The lattice cell with a number on the curve.
  Place place(const std::uint64_t number) const
  {
    const int cell = static_cast<int>(tree(static_cast<int>(number >> 3 * n_levels)));
    Place found = {
        {cell % n_coarse[0], cell / n_coarse[0] % n_coarse[1], cell / n_coarse[0] / n_coarse[1]}};
    for (unsigned int level = n_levels; level-- > 0;)
      for (unsigned int d = 0; d < 3; ++d)
        found[d] = 2 * found[d] + static_cast<int>(number >> (3 * level + d) & 1);
    return found;
  }

  const Place n_coarse;
  const unsigned int n_levels;
  const std::uint64_t n_cells;
  std::vector<std::uint64_t> starts;
};

/// Owners of all cells of a box but one's own, by their numbers on the curve.
std::set<int> owners_by_number(const FakeRanks &ranks, const CurveOwners &owners,
                               const Place &begin, const Place &end, const int own)
{
  std::set<int> found;
  for (int x = begin[0]; x < end[0]; ++x)
    for (int y = begin[1]; y < end[1]; ++y)
      for (int z = begin[2]; z < end[2]; ++z) {
        Place place = {{x, y, z}};
        bool is_inside = true;
        for (unsigned int d = 0; d < 3; ++d) {
          const int n = ranks.n_coarse[d] << ranks.n_levels;
          if (d == 2)
            place[d] = (place[d] + n) % n;
          is_inside = is_inside && place[d] >= 0 && place[d] < n;
        }
        if (!is_inside)
          continue;
        const CurveOwners::Position at = owners.position(place);
        const int rank =
            ranks.owner((static_cast<std::uint64_t>(at.first) << 3 * ranks.n_levels) + at.second);
        if (rank != own)
          found.insert(rank);
      }
  return found;
}

struct Counts
{
  std::uint64_t most_looks = 0; ///< for what is around a cell
  std::size_t most_pieces = 0, most_ranks = 0;
};

Counts look_around(const FakeRanks &ranks)
{
  std::uint64_t looks = 0;
  const CurveOwners owners = ranks.owners(looks);
  bool owned = true, same = true, ordered = true;
  std::uint64_t most_for_owner = 0;
  Counts counts;
  for (int rank = 0; rank < ranks.size(); rank += std::max(1, ranks.size() / 61)) {
    const std::uint64_t first = ranks.starts[rank];
    const std::uint64_t last = rank + 1 < ranks.size() ? ranks.starts[rank + 1] : ranks.n_cells;
    for (const std::uint64_t number : {first, (first + last) / 2, last - 1}) {
      if (first == last)
        continue;
      const Place place = ranks.place(number);
      looks = 0;
      owned = owned && owners.owner(place) == rank;
      most_for_owner = std::max(most_for_owner, looks);

      Place begin = place, end = place;
      for (unsigned int d = 0; d < 3; ++d) {
        begin[d] -= 2;
        end[d] += 3;
      }
      looks = 0;
      const std::vector<CurveOwners::Piece> found = owners.foreign(begin, end, rank);
      counts.most_looks = std::max(counts.most_looks, looks);
      counts.most_pieces = std::max(counts.most_pieces, found.size());
      std::set<int> near;
      for (std::size_t k = 0; k < found.size(); ++k) {
        near.insert(found[k].rank);
        ordered = ordered && (k == 0 || found[k - 1].rank <= found[k].rank);
      }
      counts.most_ranks = std::max(counts.most_ranks, near.size());
      same = same && near == owners_by_number(ranks, owners, begin, end, rank);
    }
  }
  const std::string name = ", " + std::to_string(ranks.size()) + " ranks";
  check("owners" + name, owned);
  check("an owner is found by bisection" + name,
        static_cast<double>(most_for_owner) <= std::ceil(std::log2(ranks.size())) + 1.);
  check("the same as one by one" + name, same && ordered);
  return counts;
}

} // namespace

EUNOE_TEST()
{
  // About as many cells a rank each time.
  const Counts few = look_around({{{4, 4, 4}}, 4, 64});
  const Counts many = look_around({{{16, 8, 32}}, 4, 4096});
  const Counts most = look_around({{{8, 16, 32}}, 5, 65536});
  // Twice for the numbers' digits, once and a half for chance.
  check("ranks around are as few",
        most.most_ranks <= few.most_ranks + 8 && many.most_ranks <= few.most_ranks + 8);
  check("pieces around are as few", 2 * most.most_pieces <= 3 * few.most_pieces);
  check("looks grow like digits", most.most_looks <= 3 * few.most_looks);
}
