// How the mesh follows the particles, and how it is divided among the ranks.

#include <eunoe/core/compat.h>

#include "particle_store_implementation.h"

#include <algorithm>
#include <array>

namespace eunoe {

namespace {

/// Whether a cell is the first of eight that this rank owns, none of which is refined.
bool begins_family(const Forest::ActiveCell &cell)
{
  if (cell->level() == 0 || cell->parent()->child_index(0) != cell->index())
    return false;
  for (unsigned int c = 1; c < 8; ++c) {
    const Forest::Cell sibling = cell->parent()->child(c);
    if (sibling->has_children() || !sibling->is_locally_owned())
      return false;
  }
  return true;
}

} // namespace

ParticleStore::Implementation::Marks ParticleStore::Implementation::marks() const
{
  // Eight to ten particles a cell are best; between the bounds cells stay as they are, so that what
  // flows does not change the mesh all the time. Where a rank has few particles, smaller cells
  // balance the load.
  const std::uint64_t of_rank =
      handler.n_global_particles() / dealii::Utilities::MPI::n_mpi_processes(domain.communicator());
  const std::uint64_t most = std::clamp<std::uint64_t>(of_rank / 128, 8, 24),
                      fewest_of_eight = most / 2;
  Marks marks;
  for (const auto &cell : forest.mesh().active_cell_iterators()) {
    if (!cell->is_locally_owned())
      continue;
    const std::uint64_t n = handler.n_particles_in_cell(cell);
    if (n > most && !forest.is_finest(cell)) {
      marks.crowded.push_back(cell);
      marks.n_crowded += n;
    } else if (n <= fewest_of_eight && begins_family(cell)) {
      std::uint64_t n_family = 0;
      for (unsigned int c = 0; c < 8; ++c)
        n_family += handler.n_particles_in_cell(cell->parent()->child(c));
      if (n_family <= fewest_of_eight)
        marks.sparse.push_back(cell->parent());
    }
  }
  return marks;
}

bool ParticleStore::Implementation::pays(const std::uint64_t crowded,
                                         const std::uint64_t unitable) const
{
  return 10 * crowded > handler.n_global_particles() ||
         2 * unitable > forest.mesh().n_global_active_cells();
}

bool ParticleStore::Implementation::mark_cells()
{
  MPI_Comm comm = domain.communicator();
  const Marks found = marks();
  std::array<std::uint64_t, 2> wanted = {{found.n_crowded, 8 * found.sparse.size()}};
  MPI_Allreduce(MPI_IN_PLACE, wanted.data(), 2, MPI_UINT64_T, MPI_SUM, comm);
  if (!pays(wanted[0], wanted[1] - std::min(wanted[1], cannot_be_united)))
    return false;
  for (const Forest::ActiveCell &cell : found.crowded)
    cell->set_refine_flag();
  for (const Forest::Cell &parent : found.sparse)
    for (unsigned int c = 0; c < 8; ++c)
      parent->child(c)->set_coarsen_flag();
  // Cells beside finer ones cannot be united.
  forest.mesh().prepare_coarsening_and_refinement();
  std::uint64_t unitable = 0;
  for (const auto &cell : forest.mesh().active_cell_iterators())
    unitable += cell->is_locally_owned() && cell->coarsen_flag_set() ? 1 : 0;
  unitable = dealii::Utilities::MPI::sum(unitable, comm);
  cannot_be_united = wanted[1] - std::min(wanted[1], unitable);
  if (pays(wanted[0], unitable))
    return true;
  for (const auto &cell : forest.mesh().active_cell_iterators()) {
    cell->clear_refine_flag();
    cell->clear_coarsen_flag();
  }
  return false;
}

void ParticleStore::adapt()
{
  Implementation &impl = *implementation;
  // A level at a time.
  for (unsigned int level = 0; level < impl.forest.most_levels() && impl.mark_cells(); ++level)
    impl.change_mesh([](Forest::Triangulation &mesh) { mesh.execute_coarsening_and_refinement(); });
}

void ParticleStore::repartition(const LoadBalancingParameters &parameters)
{
  Implementation &impl = *implementation;
  const auto connection = compat::connect_weight(impl.forest.mesh(), [&](const auto &cell) {
    constexpr double most = 1e9; // p4est's weights are int
    return static_cast<unsigned int>(
        std::min(most, impl.cell_weight(to_vec3(cell->center()), parameters) +
                           impl.weight(impl.handler.particles_in_cell(cell), parameters)));
  });
  impl.change_mesh([](Forest::Triangulation &mesh) { mesh.repartition(); });
  connection.disconnect();
}

double ParticleStore::imbalance(const LoadBalancingParameters &parameters) const
{
  Implementation &impl = *implementation;
  double load = impl.weight(impl.handler, parameters);
  for (const auto &cell : impl.forest.mesh().active_cell_iterators())
    if (cell->is_locally_owned())
      load += impl.cell_weight(to_vec3(cell->center()), parameters);
  const auto loads = dealii::Utilities::MPI::min_max_avg(load, impl.domain.communicator());
  return (loads.max - loads.min) / loads.avg;
}

} // namespace eunoe
