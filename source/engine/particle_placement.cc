// How particles find the ranks and cells that they belong to.

#include "particle_store_implementation.h"

#include <algorithm>

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
  particles.clear();
}

void ParticleStore::migrate()
{
  Implementation &impl = *implementation;
  std::vector<Implementation::Handler::particle_iterator> leaving;
  std::map<unsigned int, std::vector<double>> rows;
  for (auto particle = impl.handler.begin(); particle != impl.handler.end(); ++particle) {
    const auto values = particle->get_properties();
    const Forest::Place place = impl.place_of(load(&values[property::position], 0.).vec());
    const Forest::ActiveCell cell = impl.forest.find(place);
    if (cell == particle->get_surrounding_cell()) {
      particle->set_location(impl.forest.centre(place));
      continue;
    }
    const unsigned int owner = cell->is_locally_owned() ? impl.rank : impl.forest.owner(place);
    rows[owner].insert(rows[owner].end(), values.begin(), values.end());
    leaving.push_back(particle);
  }
  if (dealii::Utilities::MPI::sum(leaving.size(), impl.domain.communicator()) == 0)
    return;
  impl.handler.remove_particles(leaving);
  impl.hand_over(rows);
  impl.handler.update_cached_numbers();
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

  // In portions, as each is copied several times on its way.
  constexpr std::size_t portion = 50000;
  const std::size_t most =
      dealii::Utilities::MPI::max(static_cast<std::uint64_t>(particles.size()), comm);
  for (std::size_t begin = 0; begin < most; begin += portion) {
    std::map<unsigned int, std::vector<double>> rows;
    for (std::size_t k = begin; k < std::min(begin + portion, particles.size()); ++k) {
      const std::vector<double> values =
          impl.properties_of(particles[k], origins.empty() ? Origin() : origins[k], extra);
      std::vector<double> &row = rows[impl.forest.owner(impl.place_of(particles[k].position))];
      row.insert(row.end(), values.begin(), values.end());
    }
    impl.hand_over(rows);
  }
  impl.handler.update_cached_numbers();
}

} // namespace eunoe
