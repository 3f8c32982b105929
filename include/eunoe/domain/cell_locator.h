#ifndef eunoe_domain_cell_locator_h
#define eunoe_domain_cell_locator_h

// Finds the mesh cells of places, for source files only.

#include <eunoe/domain/domain.h>

#include <deal.II/distributed/tria.h>

#include <array>
#include <memory>
#include <vector>

namespace eunoe {

class BoxTree;

/// For every mesh cell of this rank its centre and its faces as planes: a place belongs to the cell
/// that it sticks out of least. So every place belongs to some cell, those too that round-off,
/// faces that are not flat or hanging nodes on a curved boundary leave outside of all.
///
/// deal.II's search inverts the mapping of each cell and loses what lies on a face.
class CellLocator
{
public:
  using Cell = dealii::Triangulation<3>::active_cell_iterator;

  explicit CellLocator(const Domain &domain);
  ~CellLocator();

  /// What is known of the best cell for a place.
  struct Fit
  {
    /// How far the place sticks out of the cell, at most (m); negative inside.
    double outside;
    Vec3 centre; ///< of the cell; of two that fit equally well, the upper one is taken
    bool is_better_than(const Fit &other) const;
  };
  /// The best of this rank's cells for a place in the frame of the mesh.
  /// @return a fit that is worse than all, if this rank has no cells
  Fit find(const Vec3 &x, Cell &cell) const;

  /// The box around this rank's cells; its corners are the wrong way round if there are none.
  const Box &box() const { return around; }

private:
  /// Bounds of a cell, relative to its centre.
  struct Bounds
  {
    Vec3 centre;
    std::array<Vec3, 6> normal;
    std::array<double, 6> offset;
  };
  double outside(const Bounds &bounds, const Vec3 &x) const;

  const PeriodicBox periods;
  Box around;
  std::vector<Cell> cells;
  std::vector<Bounds> bounds;
  std::unique_ptr<const BoxTree> tree; ///< null without cells
};

} // namespace eunoe

#endif
