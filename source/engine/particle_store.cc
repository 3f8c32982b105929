#include "particle_store_implementation.h"

#include <algorithm>
#include <stdexcept>

namespace eunoe {

ParticleStore::ParticleStore(const Domain &domain, const double least_width, const double reach,
                             const unsigned int n_extra, const std::optional<FieldHandle> asleep)
    : implementation(std::make_unique<Implementation>(domain, least_width, reach, n_extra, asleep))
{
}

ParticleStore::~ParticleStore() = default;

std::uint64_t ParticleStore::n_global() const
{
  return implementation->handler.n_global_particles();
}

std::uint64_t ParticleStore::n_cells() const
{
  return implementation->forest.mesh().n_global_active_cells();
}

void ParticleStore::write(const ParticleArrays &particles, const std::vector<double> &work)
{
  Implementation &impl = *implementation;
  const PeriodicBox &box = impl.domain.periods();
  for (std::size_t row = 0; row < particles.n_owned; ++row) {
    auto &particle = *impl.particles[row];
    const auto values = particle.get_properties();
    const Vec3 x = box.wrap(particles.position[row].vec());
    store(x, &values[property::position]);
    store(particles.velocity[row].vec(), &values[property::velocity]);
    store(particles.spin[row].vec(), &values[property::spin]);
    store(particles.force[row].vec(), &values[property::force]);
    store(particles.torque[row].vec(), &values[property::torque]);
    values[property::origin] =
        encode({static_cast<int>(impl.rank), static_cast<std::int32_t>(row)});
    values[property::work] = work[row];
    for (unsigned int e = 0; e < impl.n_extra; ++e)
      values[property::extra + e] = particles.extra[e][row];
  }
}

void ParticleStore::remove(const std::vector<std::size_t> &rows)
{
  Implementation &impl = *implementation;
  std::vector<Implementation::Handler::particle_iterator> leaving;
  for (const std::size_t row : rows)
    leaving.push_back(impl.particles[row]);
  impl.handler.remove_particles(leaving);
  impl.particles.clear();
}

void ParticleStore::read(ParticleArrays &arrays, const ContactGrid &grid,
                         std::vector<Origin> &origins)
{
  Implementation &impl = *implementation;
  struct Entry
  {
    std::uint64_t key;
    ParticleId id;
    unsigned int cell;
    Implementation::Handler::particle_iterator particle;
  };
  std::vector<Entry> entries;
  const std::size_t n = impl.handler.n_locally_owned_particles();
  entries.reserve(n);
  for (auto particle = impl.handler.begin(); particle != impl.handler.end(); ++particle)
    entries.push_back({grid.key(load(&particle->get_properties()[property::position], 0.).vec()),
                       static_cast<ParticleId>(particle->get_id()),
                       particle->get_surrounding_cell()->active_cell_index(), particle});
  std::sort(entries.begin(), entries.end(), [](const Entry &a, const Entry &b) {
    return a.key != b.key ? a.key < b.key : a.id < b.id;
  });

  arrays.resize(n, 0, impl.n_extra);
  origins.resize(n);
  impl.particles.resize(n);
  impl.cells.resize(n);
  for (std::size_t row = 0; row < n; ++row) {
    const Entry &entry = entries[row];
    impl.particles[row] = entry.particle;
    impl.cells[row] = entry.cell;
    const auto values = entry.particle->get_properties();
    const Vec3 x = load(&values[property::position], 0.).vec();
    const double radius = values[property::radius], mass = values[property::mass];
    arrays.position[row] = {x.x, x.y, x.z, radius};
    arrays.velocity[row] = load(&values[property::velocity], mass);
    arrays.spin[row] = load(&values[property::spin], 0.4 * mass * radius * radius);
    arrays.force[row] = load(&values[property::force], 0.);
    arrays.torque[row] = load(&values[property::torque], 0.);
    arrays.id[row] = entry.id;
    arrays.type[row] = static_cast<std::int32_t>(values[property::type]);
    arrays.reference[row] = x;
    origins[row] = decode(values[property::origin]);
    for (unsigned int e = 0; e < impl.n_extra; ++e)
      arrays.extra[e][row] = values[property::extra + e];
  }
}

void ParticleStore::ranks_near(const std::size_t row, const Vec3 &position, const double reach,
                               std::vector<int> &ranks) const
{
  if (reach > implementation->reach)
    throw std::logic_error("ghosts are wanted from farther away than the mesh looks");
  const PeriodicBox &box = implementation->domain.periods();
  // Particles that stick out of the domain are in its outermost cells.
  const Vec3 x = implementation->forest.clamp(implementation->domain.to_own_frame(position));
  ranks.clear();
  for (const Forest::ForeignCell &cell : implementation->near_cell[implementation->cells[row]]) {
    if (!ranks.empty() && ranks.back() == cell.rank)
      continue;
    const Vec3 away = box.shortest(x - cell.centre);
    double distance2 = 0.;
    for (unsigned int d = 0; d < 3; ++d) {
      const double outside = std::max(0., std::abs(away[d]) - cell.half[d]);
      distance2 += outside * outside;
    }
    if (distance2 <= reach * reach)
      ranks.push_back(cell.rank);
  }
}

} // namespace eunoe
