#ifndef eunoe_engine_curve_owners_h
#define eunoe_engine_curve_owners_h

#include <array>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace eunoe {

/// Which rank owns which cells of a lattice. A curve goes through all of them, from one coarse cell
/// to the next and within each in the order of Morton (as p4est numbers its quadrants), and the
/// ranks own pieces of it, one after another.
///
/// Of other ranks it knows where they begin, and finds the owner of a place by bisection; so
/// nothing that is asked of it is linear in their number.
class CurveOwners
{
public:
  /// A cell of the lattice, by its number along each axis.
  using Place = std::array<std::int32_t, 3>;
  /// A place on the curve: the number of the coarse cell on it, and that of the lattice cell in it.
  using Position = std::pair<std::int64_t, std::uint64_t>;

  /// @param n_coarse numbers of coarse cells along the axes
  /// @param n_levels how often a coarse cell is cut into eight
  /// @param is_periodic along each axis
  /// @param tree number on the curve of a coarse cell, which are numbered along x, then y, then z
  /// @param begin where a rank's piece begins; one without cells begins where the next does
  CurveOwners(const Place &n_coarse, unsigned int n_levels, const std::array<bool, 3> &is_periodic,
              std::function<std::int64_t(int cell)> tree, int n_ranks,
              std::function<Position(int rank)> begin)
      : n_coarse(n_coarse), n_levels(n_levels), is_periodic(is_periodic), tree(std::move(tree)),
        n_ranks(n_ranks), begin(std::move(begin))
  {
  }

  /// Number of the coarse cell that holds a place.
  int coarse_cell(const Place &place) const;
  /// Where the curve goes through a place.
  Position position(const Place &place) const;
  /// The rank that owns a place.
  int owner(const Place &place) const;

  /// A cube of lattice cells that one rank owns.
  struct Piece
  {
    int rank;
    Place first;
    int size; ///< along each axis, a power of two
  };
  /// What other ranks own of the box [begin, end) of the lattice, which may stick out of it, in
  /// cubes that may stick out of the box; ordered by rank.
  std::vector<Piece> foreign(const Place &begin, const Place &end, int own_rank) const;

  /// Number of the place @p code of a coarse cell, which has 2^n_bits cells along each axis, in the
  /// order of Morton: the bits of its coordinates in turn.
  static std::uint64_t in_turn(const std::array<std::uint32_t, 3> &coordinates,
                               unsigned int n_bits);

private:
  struct Cube
  {
    Place first;
    int size;
  };
  /// The coarse cells of a box of the lattice, which may stick out of it.
  std::vector<Cube> coarse_cells(const Place &begin, const Place &end) const;
  /// Whether a cube, or one of its images across periodic ends, has cells of such a box.
  bool overlap(const Cube &cube, const Place &begin, const Place &end) const;

  const Place n_coarse;
  const unsigned int n_levels;
  const std::array<bool, 3> is_periodic;
  const std::function<std::int64_t(int cell)> tree;
  const int n_ranks;
  const std::function<Position(int rank)> begin;
};

} // namespace eunoe

#endif
