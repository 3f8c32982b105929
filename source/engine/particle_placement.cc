// How particles find the ranks and cells that they belong to.

#include "particle_store_implementation.h"

#include <algorithm>

namespace eunoe {

void ParticleStore::Implementation::append_traveller(const Forest::Place &place,
                                                     const ParticleId id,
                                                     const double *const properties,
                                                     std::vector<double> &travellers)
{
  travellers.insert(travellers.end(), place.begin(), place.end());
  travellers.push_back(id);
  travellers.insert(travellers.end(), properties, properties + property::n);
}

void ParticleStore::Implementation::take(const std::vector<double> &travellers)
{
  for (std::size_t begin = 0; begin < travellers.size(); begin += traveller_size) {
    const double *const values = &travellers[begin];
    Forest::Place place;
    std::transform(values, values + 3, place.begin(),
                   [](const double value) { return static_cast<std::int32_t>(value); });
    const Forest::ActiveCell cell = forest.find(place);
    if (!cell->is_locally_owned())
      throw std::logic_error("a particle has come to a rank that does not own its place");
    const dealii::Point<3> centre = forest.centre(place);
    handler.insert_particle(centre, forest.get_mapping().transform_real_to_unit_cell(cell, centre),
                            static_cast<dealii::types::particle_index>(values[3]), cell,
                            dealii::ArrayView<const double>(values + 4, property::n));
  }
}

void ParticleStore::Implementation::hand_over(
    std::map<unsigned int, std::vector<double>> &travellers)
{
  const auto own = travellers.find(rank);
  if (own != travellers.end()) {
    take(own->second);
    travellers.erase(own);
  }
  for (const auto &[from, list] :
       dealii::Utilities::MPI::some_to_some(domain.communicator(), travellers))
    take(list);
}

void ParticleStore::migrate()
{
  Implementation &impl = *implementation;
  std::vector<Implementation::Handler::particle_iterator> leaving;
  std::map<unsigned int, std::vector<double>> travellers;
  for (auto particle = impl.handler.begin(); particle != impl.handler.end(); ++particle) {
    const auto properties = particle->get_properties();
    const Origin origin = decode(properties[property::origin]);
    // New ones have just found their cells.
    if (origin.rank != static_cast<int>(impl.rank) || impl.is_new(origin.row))
      continue;
    const Forest::Place place = impl.place_of(impl.reference(origin.row));
    const Forest::ActiveCell cell = impl.forest.find(place);
    if (cell == particle->get_surrounding_cell()) {
      particle->set_location(impl.forest.centre(place));
      continue;
    }
    const unsigned int owner = cell->is_locally_owned() ? impl.rank : impl.forest.owner(place);
    Implementation::append_traveller(place, static_cast<ParticleId>(particle->get_id()),
                                     properties.begin(), travellers[owner]);
    leaving.push_back(particle);
  }
  if (dealii::Utilities::MPI::sum(leaving.size(), impl.domain.communicator()) == 0)
    return;
  impl.handler.remove_particles(leaving);
  impl.hand_over(travellers);
  impl.handler.update_cached_numbers();
}

void ParticleStore::insert(std::vector<NewParticle> &&particles, const std::vector<double> &extra,
                           std::vector<Origin> &&contacts)
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

  impl.incoming = std::move(particles);
  impl.incoming_contacts = std::move(contacts);
  impl.incoming_extra = extra;
  // In portions, as each is copied several times on its way.
  constexpr std::size_t portion = 50000;
  const std::size_t n = impl.incoming.size();
  const std::size_t most = dealii::Utilities::MPI::max(static_cast<std::uint64_t>(n), comm);
  for (std::size_t begin = 0; begin < most; begin += portion) {
    std::map<unsigned int, std::vector<double>> travellers;
    for (std::size_t k = begin; k < std::min(begin + portion, n); ++k) {
      const auto row = static_cast<std::int32_t>(impl.n_written() + k);
      const Forest::Place place = impl.place_of(impl.reference(row));
      const double properties[property::n] = {encode({static_cast<int>(impl.rank), row}), 1., 0.};
      Implementation::append_traveller(place, impl.incoming[k].id, properties,
                                       travellers[impl.forest.owner(place)]);
    }
    impl.hand_over(travellers);
  }
  impl.handler.update_cached_numbers();
}

} // namespace eunoe
