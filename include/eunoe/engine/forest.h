#ifndef eunoe_engine_forest_h
#define eunoe_engine_forest_h

// The mesh of the engine, for source files only.

#include <eunoe/domain/domain.h>
#include <eunoe/engine/curve_owners.h>

#include <deal.II/base/point.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/fe/mapping_cartesian.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace eunoe {

/// The mesh that distributes the particles: a p4est forest of boxes along the axes around the
/// domain, in the frame in which that is at rest. Its cells are fine where particles are and coarse
/// elsewhere. The mesh of the input has no part in it, and no result depends on it.
///
/// All cells are unions of the cells of a lattice, the finest that there can be. What is asked of
/// the mesh is asked of the lattice, in whole numbers, so that a place on a face belongs to one
/// cell, and a place outside to the nearest.
class Forest
{
public:
  using Triangulation = dealii::parallel::distributed::Triangulation<3>;
  using Cell = Triangulation::cell_iterator;
  using ActiveCell = Triangulation::active_cell_iterator;
  using Place = CurveOwners::Place;

  /// @param least_width of a cell (m), unless the domain is narrower
  Forest(const Domain &domain, double least_width);

  /// The lattice cell of a position.
  Place place(const Vec3 &position) const;
  /// The centre of a lattice cell, which lies well inside of its cell on every level.
  dealii::Point<3> centre(const Place &place) const;

  /// The finest cell at a place that this rank knows; of another rank's it may know a coarser one.
  ActiveCell find(const Place &place) const;
  /// The rank that owns a place.
  unsigned int owner(const Place &place) const
  {
    return static_cast<unsigned int>(owners->owner(place));
  }
  /// How often a coarse cell can be cut into eight.
  unsigned int most_levels() const { return n_levels; }
  /// Whether a cell can be cut no more.
  bool is_finest(const ActiveCell &cell) const
  {
    return static_cast<unsigned int>(cell->level()) >= n_levels;
  }

  /// A cube of lattice cells that another rank owns.
  struct ForeignCell
  {
    int rank;
    Vec3 centre, half; ///< (m)
  };
  /// What others own within @p reach (m) of each cell of this rank, across periodic ends, too: by
  /// active cell index, ordered by rank.
  std::vector<std::vector<ForeignCell>> foreign_neighbours(double reach) const;

  /// The nearest point of the box around the domain; in periodic directions every point is in it.
  Vec3 clamp(Vec3 x) const;

  Triangulation &mesh() { return triangulation; }
  const Triangulation &mesh() const { return triangulation; }
  const dealii::Mapping<3> &get_mapping() const { return mapping; }

private:
  /// Where a rank's piece of p4est's curve begins.
  CurveOwners::Position begin_of(int rank) const;
  /// What others own within @p reach (m) of a cell, ordered by rank.
  std::vector<ForeignCell> foreign_near(const ActiveCell &cell, double reach,
                                        unsigned int own_rank) const;

  const PeriodicBox box;
  const Vec3 lower, upper;
  unsigned int n_levels = 0; ///< between the coarse cells and those of the lattice
  Place n_coarse;            ///< numbers of coarse cells
  Vec3 width;                ///< of a lattice cell (m)
  Triangulation triangulation;
  const dealii::MappingCartesian<3> mapping;
  std::unique_ptr<const CurveOwners> owners;
};

} // namespace eunoe

#endif
