#include <eunoe/engine/curve_owners.h>

#include <algorithm>
#include <set>

namespace eunoe {

std::uint64_t CurveOwners::in_turn(const std::array<std::uint32_t, 3> &coordinates,
                                   const unsigned int n_bits)
{
  std::uint64_t code = 0;
  for (unsigned int bit = n_bits; bit-- > 0;)
    for (unsigned int d = 3; d-- > 0;)
      code = code << 1 | (coordinates[d] >> bit & 1);
  return code;
}

int CurveOwners::coarse_cell(const Place &place) const
{
  return (place[0] >> n_levels) +
         n_coarse[0] * ((place[1] >> n_levels) + n_coarse[1] * (place[2] >> n_levels));
}

CurveOwners::Position CurveOwners::position(const Place &place) const
{
  const std::uint32_t mask = (1u << n_levels) - 1u;
  std::array<std::uint32_t, 3> within;
  for (unsigned int d = 0; d < 3; ++d)
    within[d] = static_cast<std::uint32_t>(place[d]) & mask;
  return {tree(coarse_cell(place)), in_turn(within, n_levels)};
}

int CurveOwners::owner(const Place &place) const
{
  const Position at = position(place);
  // The last rank that begins at the place or before it; one without cells begins where the next
  // one does.
  int first = 0, last = n_ranks;
  while (first < last) {
    const int middle = first + (last - first) / 2;
    if (at < begin(middle))
      last = middle;
    else
      first = middle + 1;
  }
  return first - 1;
}

std::vector<CurveOwners::Cube> CurveOwners::coarse_cells(const Place &begin, const Place &end) const
{
  // First the ranges along each axis, cut at the ends of the domain or continued behind them.
  std::array<std::set<int>, 3> along;
  const int size = 1 << n_levels;
  for (unsigned int d = 0; d < 3; ++d)
    for (int c = begin[d] >> n_levels; c * size < end[d]; ++c)
      if (is_periodic[d])
        along[d].insert((c % n_coarse[d] + n_coarse[d]) % n_coarse[d]);
      else if (c >= 0 && c < n_coarse[d])
        along[d].insert(c);
  std::vector<Cube> cubes;
  for (const int x : along[0])
    for (const int y : along[1])
      for (const int z : along[2])
        cubes.push_back({{{x * size, y * size, z * size}}, size});
  return cubes;
}

bool CurveOwners::overlap(const Cube &cube, const Place &begin, const Place &end) const
{
  for (unsigned int d = 0; d < 3; ++d) {
    const int n = n_coarse[d] << n_levels;
    bool some = false;
    for (const int shift : {-n, 0, n})
      some = some || ((shift == 0 || is_periodic[d]) && cube.first[d] + shift < end[d] &&
                      cube.first[d] + shift + cube.size > begin[d]);
    if (!some)
      return false;
  }
  return true;
}

std::vector<CurveOwners::Piece> CurveOwners::foreign(const Place &box_begin, const Place &box_end,
                                                     const int own_rank) const
{
  std::vector<Piece> found;
  std::vector<Cube> cubes = coarse_cells(box_begin, box_end);
  while (!cubes.empty()) {
    const Cube cube = cubes.back();
    cubes.pop_back();
    if (!overlap(cube, box_begin, box_end))
      continue;
    Place last = cube.first;
    for (int &coordinate : last)
      coordinate += cube.size - 1;
    const int rank = owner(cube.first);
    if (rank == owner(last)) {
      // A piece of the curve, so all of it has one owner.
      if (rank != own_rank)
        found.push_back({rank, cube.first, cube.size});
      continue;
    }
    const int half = cube.size / 2;
    for (int child = 0; child < 8; ++child)
      cubes.push_back(
          {{{cube.first[0] + (child & 1) * half, cube.first[1] + (child >> 1 & 1) * half,
             cube.first[2] + (child >> 2) * half}},
           half});
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Piece &one, const Piece &two) { return one.rank < two.rank; });
  return found;
}

} // namespace eunoe
