#ifndef eunoe_contact_contact_grid_h
#define eunoe_contact_contact_grid_h

#include <eunoe/contact/pair_list.h>
#include <eunoe/core/periodic_box.h>
#include <eunoe/state/particle_arrays.h>

#include <array>
#include <cstdint>
#include <vector>

namespace eunoe {

/// A grid of cells as wide as the contact search reaches, the same on every rank. It orders the
/// particles and finds the pairs. It is not the distributed background mesh, which is coarser.
class ContactGrid
{
public:
  /// @param lower, upper corners of the domain, from its centre (m); places outside belong to
  ///                     the border cells
  /// @param cell_size smallest allowed width of a cell (m)
  ContactGrid(const Vec3 &lower, const Vec3 &upper, const PeriodicBox &box, double cell_size);

  /// Takes the grid along with the domain, whose centre is at first the origin (m).
  void move_to(const Vec3 &centre) { lower = lower_from_centre + centre; }

  /// Place of a position's cell in the order of all cells; near positions have near keys.
  std::uint64_t key(const Vec3 &x) const;

  using Cell = std::array<int, 3>;

  /// What a search leaves for the next one, if the rows stay the same.
  struct Found
  {
    Vec3 lower; ///< of the grid
    /// Places in the list, [begin, end), of the pairs of which a row comes first in the order of
    /// cells.
    struct Group
    {
      std::uint32_t begin, end;
    };
    std::vector<Group> groups; ///< by row
  };

  /// A particle that has another reference than at the last search.
  struct Moved
  {
    std::int32_t row;
    Vec3 from; ///< the former one (m)
  };

  /// Lists all pairs with at least one owned particle and, where their references are, a separation
  /// of at most @p reach (m). A particle whose reference is not a number has no pairs.
  /// @param found where to leave what find_pairs_again needs, or null
  void find_pairs(const ParticleArrays &particles, double reach, PairList &pairs,
                  Found *found = nullptr) const;

  /// The same for rows of the last search: pairs around which nothing has moved since are taken
  /// over from the list.
  /// @param pairs the list of the last search; afterwards the new one, with what contacts remember
  /// @param found what the last search left
  void find_pairs_again(const ParticleArrays &particles, double reach,
                        const std::vector<Moved> &moved, PairList &pairs, Found &found) const;

private:
  Cell cell(const Vec3 &x) const;
  std::vector<Cell> cells_of(const ParticleArrays &particles) const;
  std::array<bool, 3> periodic_axes() const;

  Vec3 lower_from_centre, lower;
  Vec3 inverse_width;
  PeriodicBox box;
  Cell n;
  /// Axis of the outermost, middle and innermost loop over cells: longest first, so that
  /// neighbours stay close in memory.
  Cell axis;
};

} // namespace eunoe

#endif
