// How particles find the ranks and cells that they belong to.

#include "particle_store_implementation.h"

#include <algorithm>
#include <array>

namespace eunoe {

void ParticleStore::Implementation::take(const std::vector<double> &rows)
{
  const std::size_t n_values = property::extra + n_extra;
  for (std::size_t begin = 0; begin < rows.size(); begin += n_values) {
    const double *const values = &rows[begin];
    const Forest::Place place = place_of(load(values + property::position, 0.).vec());
    const Forest::ActiveCell cell = forest.find(place);
    if (!cell->is_locally_owned())
      throw std::logic_error("a particle has come to a rank that does not own its place");
    const dealii::Point<3> centre = forest.centre(place);
    handler.insert_particle(centre, forest.get_mapping().transform_real_to_unit_cell(cell, centre),
                            static_cast<dealii::types::particle_index>(values[property::id]), cell,
                            dealii::ArrayView<const double>(values, n_values));
  }
}

void ParticleStore::Implementation::hand_over(std::map<unsigned int, std::vector<double>> &rows)
{
  const auto own = rows.find(rank);
  if (own != rows.end()) {
    take(own->second);
    rows.erase(own);
  }
  for (const auto &[from, parcel] :
       dealii::Utilities::MPI::some_to_some(domain.communicator(), rows))
    take(parcel);
  rows.clear();
  handler.update_cached_numbers();
  particles.clear();
}

void ParticleStore::insert(const std::vector<NewParticle> &particles,
                           const std::vector<double> &extra, const std::vector<Origin> &origins)
{
  Implementation &impl = *implementation;
  MPI_Comm comm = impl.domain.communicator();
  const std::uint64_t outside = dealii::Utilities::MPI::sum(
      static_cast<std::uint64_t>(
          std::count_if(particles.begin(), particles.end(),
                        [&](const NewParticle &p) { return !impl.domain.contains(p.position); })),
      comm);
  if (outside > 0)
    throw UserError("Of the particles to insert, " + std::to_string(outside) +
                    " lie outside the mesh. Enlarge the mesh or move the place of insertion.");

  std::map<unsigned int, std::vector<double>> rows;
  for (std::size_t k = 0; k < particles.size(); ++k) {
    const std::vector<double> values =
        impl.properties_of(particles[k], origins.empty() ? Origin() : origins[k], extra);
    std::vector<double> &row = rows[impl.forest.owner(impl.place_of(particles[k].position))];
    row.insert(row.end(), values.begin(), values.end());
  }
  impl.hand_over(rows);
}

bool ParticleStore::Implementation::mark_cells()
{
  // Eight to ten particles a cell are best; between the bounds cells stay as they are, so that what
  // flows does not change the mesh all the time. Where a rank has few particles, smaller cells
  // balance the load.
  const std::uint64_t of_rank =
      handler.n_global_particles() / dealii::Utilities::MPI::n_mpi_processes(domain.communicator());
  const auto most = static_cast<unsigned int>(
      std::min<std::uint64_t>(24, std::max<std::uint64_t>(8, of_rank / 128)));
  const unsigned int fewest_of_eight = most / 2;
  std::vector<Forest::ActiveCell> crowded;
  std::map<Forest::Cell, std::pair<unsigned int, unsigned int>> families;
  std::array<std::uint64_t, 2> counts = {{0, 0}}; // Particles in crowded cells; cells to unite.
  for (const auto &cell : forest.mesh().active_cell_iterators()) {
    if (!cell->is_locally_owned())
      continue;
    const auto n = static_cast<unsigned int>(handler.n_particles_in_cell(cell));
    if (n > most && !forest.is_finest(cell)) {
      crowded.push_back(cell);
      counts[0] += n;
    } else if (cell->level() > 0 && n <= fewest_of_eight) {
      auto &[n_cells, n_particles] = families[cell->parent()];
      ++n_cells;
      n_particles += n;
    }
  }
  const auto is_sparse = [fewest_of_eight](const auto &family) {
    return family.second.first == 8 && family.second.second <= fewest_of_eight;
  };
  counts[1] = 8 * std::count_if(families.begin(), families.end(), is_sparse);
  const auto pays = [&](const std::uint64_t in_vain) {
    std::array<std::uint64_t, 2> sums = counts;
    MPI_Allreduce(MPI_IN_PLACE, sums.data(), 2, MPI_UINT64_T, MPI_SUM, domain.communicator());
    return 10 * sums[0] > handler.n_global_particles() ||
           2 * sums[1] > forest.mesh().n_global_active_cells() + 2 * in_vain;
  };
  if (!pays(cannot_be_united))
    return false;
  for (const Forest::ActiveCell &cell : crowded)
    cell->set_refine_flag();
  for (const auto &family : families)
    if (is_sparse(family))
      for (unsigned int c = 0; c < 8; ++c)
        family.first->child(c)->set_coarsen_flag();
  // Cells beside finer ones cannot be united.
  forest.mesh().prepare_coarsening_and_refinement();
  cannot_be_united = dealii::Utilities::MPI::sum(counts[1], domain.communicator());
  counts[1] = 0;
  for (const auto &cell : forest.mesh().active_cell_iterators())
    counts[1] += cell->is_locally_owned() && cell->coarsen_flag_set() ? 1 : 0;
  cannot_be_united -= dealii::Utilities::MPI::sum(counts[1], domain.communicator());
  if (pays(0))
    return true;
  for (const auto &cell : forest.mesh().active_cell_iterators()) {
    cell->clear_refine_flag();
    cell->clear_coarsen_flag();
  }
  return false;
}

} // namespace eunoe
