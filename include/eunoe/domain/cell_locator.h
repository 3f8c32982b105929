#ifndef eunoe_domain_cell_locator_h
#define eunoe_domain_cell_locator_h

// Finds the mesh cells of particles in meshes whose cells are not boxes of one size, for source
// files only.

#include <eunoe/domain/domain.h>

#include <deal.II/base/bounding_box.h>
#include <deal.II/distributed/tria.h>

#include <array>
#include <memory>
#include <vector>

namespace eunoe {

class BoxTree;

/// For every cell its centre and its faces as planes: a place belongs to the cell that it sticks
/// out of least. So every place belongs to some cell, even if round-off, curved faces or hanging
/// nodes on a curved boundary leave it outside of all cells.
///
/// deal.II's search inverts the mapping of each cell and loses points that lie on a face.
class CellLocator
{
public:
  using Cell = dealii::Triangulation<3>::active_cell_iterator;

  explicit CellLocator(Domain &domain);
  ~CellLocator();

  /// Reads the cells anew after load balancing; must be called first.
  void rebuild();

  /// How far a place sticks out of a cell by its active index, at most (m); negative inside.
  double outside(unsigned int cell, const Vec3 &x) const;
  /// Distance of a place from the box around a cell (m).
  double gap(unsigned int cell, const Vec3 &x) const;
  /// The cell of a place near a known cell, among those that this rank owns and their neighbours.
  unsigned int walk(unsigned int from, const Vec3 &x) const;
  /// The cell of a place among those that this rank owns; the rank must own at least one.
  unsigned int find(const Vec3 &x) const;

  const Cell &cell(unsigned int index) const { return cells[index]; }

private:
  /// Bounds of a cell, relative to its centre.
  struct Bounds
  {
    Vec3 centre, lower, upper;
    std::array<Vec3, 6> normal;
    std::array<double, 6> offset;
  };

  Domain &domain;
  std::vector<Cell> cells;
  std::vector<Bounds> bounds;
  /// Cells around a vertex, of all vertices that coincide over periodic faces; by vertex.
  std::vector<std::vector<unsigned int>> at_vertex;
  std::vector<unsigned int> representative;
  std::unique_ptr<const BoxTree> tree;
};

} // namespace eunoe

#endif
