#ifndef eunoe_contact_contact_grid_h
#define eunoe_contact_contact_grid_h

#include <eunoe/contact/pair_list.h>
#include <eunoe/core/periodic_box.h>
#include <eunoe/state/particle_arrays.h>

#include <array>
#include <cstdint>

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

  /// Lists all pairs with at least one owned particle and a separation of at most @p reach (m).
  /// The positions are those of the search; owned and ghost particles must each be ordered by
  /// (key, id).
  void find_pairs(const ParticleArrays &particles, double reach, PairList &pairs) const;

private:
  using Cell = std::array<int, 3>;

  Cell cell(const Vec3 &x) const;

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
