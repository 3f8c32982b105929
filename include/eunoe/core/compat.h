#ifndef eunoe_core_compat_h
#define eunoe_core_compat_h

// What differs between the versions of deal.II that the project compiles against (9.4.1 onwards),
// in one place. For source files that include deal.II.

#include <deal.II/base/config.h>
#include <deal.II/base/data_out_base.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/particles/particle_handler.h>

namespace eunoe::compat {

/// Calls @p weight for every cell that stays, is refined or united, whenever the mesh is
/// partitioned.
template <typename Weight>
boost::signals2::connection connect_weight(dealii::parallel::distributed::Triangulation<3> &mesh,
                                           const Weight &weight)
{
#if DEAL_II_VERSION_GTE(9, 5, 0)
  return mesh.signals.weight.connect(
      [weight](const auto &cell, const auto) -> unsigned int { return weight(cell); });
#else
  // Here the base weight of 1000 that the other signal adds does not exist.
  return mesh.signals.weight.connect(
      [weight](const dealii::Triangulation<3>::cell_iterator &cell,
               const dealii::Triangulation<3>::CellStatus) -> unsigned int {
        return weight(cell);
      });
#endif
}

/// Options of a .vtu file: quick compression, no date (so that equal runs give equal files).
inline dealii::DataOutBase::VtkFlags vtu_flags(double time, unsigned int cycle)
{
#if DEAL_II_VERSION_GTE(9, 5, 0)
  const auto level = dealii::DataOutBase::CompressionLevel::best_speed;
#else
  const auto level = dealii::DataOutBase::VtkFlags::best_speed;
#endif
  return dealii::DataOutBase::VtkFlags(time, cycle, false, level);
}

} // namespace eunoe::compat

#endif
