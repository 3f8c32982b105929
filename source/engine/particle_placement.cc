// How new particles find the ranks and cells that they belong to.

#include <deal.II/grid/filtered_iterator.h>
#include <deal.II/grid/grid_tools.h>

#include "particle_store_implementation.h"

#include <algorithm>
#include <limits>

namespace eunoe {

void ParticleStore::Implementation::insert_by_handler(
    const std::vector<std::vector<double>> &properties, const std::vector<NewParticle> &particles)
{
  MPI_Comm comm = domain.communicator();
  const auto owned = dealii::IteratorFilters::LocallyOwnedCell();
  const auto boxes = dealii::Utilities::MPI::all_gather(
      comm,
      dealii::GridTools::compute_mesh_predicate_bounding_box(
          triangulation,
          std::function<bool(const dealii::Triangulation<3>::active_cell_iterator &)>(owned)));
  // In portions, as each is copied several times on its way.
  constexpr std::size_t portion = 50000;
  const std::size_t most =
      dealii::Utilities::MPI::max(static_cast<std::uint64_t>(particles.size()), comm);
  for (std::size_t begin = 0; begin < most; begin += portion) {
    std::vector<dealii::Point<3>> positions;
    std::vector<std::vector<double>> share;
    for (std::size_t k = begin; k < std::min(begin + portion, particles.size()); ++k) {
      positions.push_back(to_point(domain.periods().wrap(particles[k].position)));
      share.push_back(properties[k]);
    }
    // Ids go with the properties: given apart, they are exchanged only among ranks that have
    // particles to insert, and these wait for the others forever (deal.II 9.4).
    handler.insert_global_particles(positions, boxes, share);
  }
}

void ParticleStore::Implementation::insert_by_locator(
    const std::vector<std::vector<double>> &properties)
{
  MPI_Comm comm = domain.communicator();
  constexpr std::size_t portion = 50000;
  const std::size_t most =
      dealii::Utilities::MPI::max(static_cast<std::uint64_t>(properties.size()), comm);
  for (std::size_t begin = 0; begin < most; begin += portion) {
    std::vector<double> mine;
    for (std::size_t k = begin; k < std::min(begin + portion, properties.size()); ++k)
      mine.insert(mine.end(), properties[k].begin(), properties[k].end());
    std::vector<double> all;
    for (const auto &part : dealii::Utilities::MPI::all_gather(comm, mine))
      all.insert(all.end(), part.begin(), part.end());
    take_best_fitting(all);
  }
  handler.update_cached_numbers();
}

void ParticleStore::Implementation::take_best_fitting(const std::vector<double> &rows)
{
  MPI_Comm comm = domain.communicator();
  const std::size_t n_values = property::extra + n_extra + 3, n = rows.size() / n_values;
  const bool has_cells = triangulation.n_locally_owned_active_cells() > 0;
  std::vector<double> outside(n, std::numeric_limits<double>::max());
  std::vector<unsigned int> found(n);
  for (std::size_t k = 0; has_cells && k < n; ++k) {
    const Vec3 x =
        domain.to_own_frame(load(&rows[k * n_values + property::extra + n_extra], 0.).vec());
    found[k] = locator->find(x);
    outside[k] = locator->outside(found[k], x);
  }
  std::vector<double> least = outside;
  MPI_Allreduce(MPI_IN_PLACE, least.data(), static_cast<int>(n), MPI_DOUBLE, MPI_MIN, comm);
  std::vector<int> owner(n, std::numeric_limits<int>::max());
  for (std::size_t k = 0; k < n; ++k)
    if (outside[k] == least[k])
      owner[k] = rank;
  MPI_Allreduce(MPI_IN_PLACE, owner.data(), static_cast<int>(n), MPI_INT, MPI_MIN, comm);
  for (std::size_t k = 0; k < n; ++k) {
    if (owner[k] != rank)
      continue;
    const CellLocator::Cell &cell = locator->cell(found[k]);
    const double *const values = &rows[k * n_values];
    handler.insert_particle(cell->center(), dealii::Point<3>(0.5, 0.5, 0.5),
                            static_cast<dealii::types::particle_index>(values[property::id]), cell,
                            dealii::ArrayView<const double>(values, n_values));
  }
}

void ParticleStore::insert(const std::vector<NewParticle> &particles,
                           const std::vector<double> &extra, const std::vector<Origin> &origins)
{
  Implementation &impl = *implementation;
  MPI_Comm comm = impl.domain.communicator();
  // Refused here, as the search for the cells of such points never returns.
  const std::uint64_t outside = dealii::Utilities::MPI::sum(
      static_cast<std::uint64_t>(
          std::count_if(particles.begin(), particles.end(),
                        [&](const NewParticle &p) { return !impl.domain.contains(p.position); })),
      comm);
  if (outside > 0)
    throw UserError("Of the particles to insert, " + std::to_string(outside) +
                    " lie outside the mesh. Enlarge the mesh or move the place of insertion.");

  std::vector<std::vector<double>> properties;
  for (std::size_t k = 0; k < particles.size(); ++k)
    properties.push_back(
        impl.properties_of(particles[k], origins.empty() ? Origin() : origins[k], extra));
  const std::uint64_t expected =
      n_global() + dealii::Utilities::MPI::sum(static_cast<std::uint64_t>(particles.size()), comm);
  if (impl.locator)
    impl.insert_by_locator(properties);
  else
    impl.insert_by_handler(properties, particles);
  for (auto particle = impl.handler.begin(); particle != impl.handler.end(); ++particle)
    particle->set_id(
        static_cast<dealii::types::particle_index>(particle->get_properties()[property::id]));
  if (n_global() != expected)
    throw std::logic_error("the mesh did not take over all inserted particles");
}

} // namespace eunoe
