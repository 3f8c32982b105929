#include <eunoe/core/compat.h>
#include <eunoe/engine/load_balancing.h>

#include <deal.II/grid/grid_tools.h>

#include "particle_store_implementation.h"

#include <algorithm>
#include <set>

namespace eunoe {

void ParticleStore::Implementation::find_foreign_neighbours()
{
  // Vertices that coincide, also across periodic faces, count as one.
  std::map<unsigned int, std::vector<unsigned int>> groups;
  std::map<unsigned int, unsigned int> group_of;
  dealii::GridTools::collect_coinciding_vertices(triangulation, groups, group_of);
  const auto representative = [&](unsigned int v) {
    const auto it = group_of.find(v);
    return it == group_of.end() ? v : groups.at(it->second).front();
  };
  std::vector<std::set<unsigned int>> foreign_at(triangulation.n_vertices());
  for (const auto &cell : triangulation.active_cell_iterators())
    if (cell->is_ghost())
      for (const unsigned int v : cell->vertex_indices())
        foreign_at[representative(cell->vertex_index(v))].insert(cell->active_cell_index());
  std::vector<ForeignCell> foreign(triangulation.n_active_cells());
  for (const auto &cell : triangulation.active_cell_iterators())
    if (cell->is_ghost()) {
      const dealii::BoundingBox<3> box = cell->bounding_box();
      const auto &corners = box.get_boundary_points();
      const Vec3 lower = to_vec3(corners.first), upper = to_vec3(corners.second);
      foreign[cell->active_cell_index()] = {static_cast<int>(cell->subdomain_id()),
                                            0.5 * (lower + upper), 0.5 * (upper - lower)};
    }
  near_cell.assign(triangulation.n_active_cells(), {});
  for (const auto &cell : triangulation.active_cell_iterators())
    if (cell->is_locally_owned()) {
      std::set<unsigned int> cells_around;
      for (const unsigned int v : cell->vertex_indices()) {
        const auto &at = foreign_at[representative(cell->vertex_index(v))];
        cells_around.insert(at.begin(), at.end());
      }
      std::vector<ForeignCell> &near = near_cell[cell->active_cell_index()];
      for (const unsigned int c : cells_around)
        near.push_back(foreign[c]);
      std::stable_sort(
          near.begin(), near.end(),
          [](const ForeignCell &one, const ForeignCell &two) { return one.rank < two.rank; });
    }
}

void ParticleStore::Implementation::measure_gaps(const ParticleArrays &arrays)
{
  largest_gap = 0.;
  for (std::size_t row = 0; row < arrays.n_owned; ++row)
    largest_gap = std::max(
        largest_gap, locator->gap(cells[row], domain.to_own_frame(arrays.position[row].vec())));
  largest_gap = dealii::Utilities::MPI::max(largest_gap, domain.communicator());
  if (largest_gap > 0.5 * domain.smallest_cell_width())
    throw UserError("A particle is " + format(largest_gap) +
                    " m away from the cells of the mesh. Check the time step and the solids, or "
                    "make the cells at the boundary smaller, so that they follow it more closely.");
}

ParticleStore::ParticleStore(Domain &domain, const unsigned int n_extra,
                             const std::optional<FieldHandle> asleep)
    : implementation(std::make_unique<Implementation>(domain, n_extra, asleep))
{
}

ParticleStore::~ParticleStore() = default;

std::uint64_t ParticleStore::n_global() const
{
  return implementation->handler.n_global_particles();
}

void ParticleStore::write(const ParticleArrays &particles, const std::vector<double> &work)
{
  Implementation &impl = *implementation;
  const PeriodicBox &box = impl.domain.periods();
  for (std::size_t row = 0; row < particles.n_owned; ++row) {
    auto &particle = *impl.particles[row];
    const auto values = particle.get_properties();
    const Vec3 x = box.wrap(particles.position[row].vec());
    if (impl.locator) {
      const Vec3 own = impl.domain.to_own_frame(x);
      particle.set_location(impl.locator->cell(impl.locator->walk(impl.cells[row], own))->center());
      store(x, &values[property::extra + impl.n_extra]);
    } else
      particle.set_location(to_point(x));
    store(particles.velocity[row].vec(), &values[property::velocity]);
    store(particles.spin[row].vec(), &values[property::spin]);
    store(particles.force[row].vec(), &values[property::force]);
    store(particles.torque[row].vec(), &values[property::torque]);
    values[property::origin] = encode({impl.rank, static_cast<std::int32_t>(row)});
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

void ParticleStore::migrate()
{
  Implementation &impl = *implementation;
  const std::uint64_t before = n_global();
  std::string lost;
  const auto connection =
      impl.handler.signals.particle_lost.connect([&](const auto &particle, const auto &) {
        if (lost.empty()) {
          std::ostringstream text;
          text << "particle " << particle->get_id() << " at (" << particle->get_location() << ")";
          lost = text.str();
        }
      });
  impl.handler.sort_particles_into_subdomains_and_cells();
  connection.disconnect();
  impl.particles.clear();
  if (n_global() == before)
    return;
  const std::vector<std::string> all =
      dealii::Utilities::MPI::all_gather(impl.domain.communicator(), lost);
  const auto first = std::find_if(all.begin(), all.end(), [](const auto &s) { return !s.empty(); });
  throw UserError(std::to_string(before - n_global()) + " particle(s) left the mesh" +
                  (first == all.end() ? std::string() : ", " + *first + " m among them") +
                  ". Check the time step and the solids, or make the boundary an outlet.");
}

void ParticleStore::repartition(const LoadBalancingParameters &parameters)
{
  Implementation &impl = *implementation;
  const auto connection = compat::connect_weight(impl.triangulation, [&](const auto &cell) {
    return static_cast<unsigned int>(impl.cell_weight(to_vec3(cell->center()), parameters) +
                                     impl.weight(impl.handler.particles_in_cell(cell), parameters));
  });
  impl.handler.prepare_for_coarsening_and_refinement();
  impl.triangulation.repartition();
  impl.handler.unpack_after_coarsening_and_refinement();
  connection.disconnect();
  impl.look_at_cells();
  impl.particles.clear();
}

double ParticleStore::imbalance(const LoadBalancingParameters &parameters) const
{
  Implementation &impl = *implementation;
  double load = impl.weight(impl.handler, parameters);
  for (const auto &cell : impl.triangulation.active_cell_iterators())
    if (cell->is_locally_owned())
      load += impl.cell_weight(to_vec3(cell->center()), parameters);
  const auto loads = dealii::Utilities::MPI::min_max_avg(load, impl.domain.communicator());
  return (loads.max - loads.min) / loads.avg;
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
    entries.push_back({grid.key(impl.position_of(*particle)),
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
    const Vec3 x = impl.position_of(*entry.particle);
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
  if (impl.locator)
    impl.measure_gaps(arrays);
}

unsigned int ParticleStore::cell(const std::size_t row) const
{
  return implementation->cells[row];
}

void ParticleStore::ranks_near(const std::size_t row, const Vec3 &position, const double reach,
                               std::vector<int> &ranks) const
{
  const PeriodicBox &box = implementation->domain.periods();
  const Vec3 x = implementation->domain.to_own_frame(position);
  ranks.clear();
  for (const auto &cell : implementation->near_cell[implementation->cells[row]]) {
    if (!ranks.empty() && ranks.back() == cell.rank)
      continue;
    const Vec3 away = box.shortest(x - cell.centre);
    double distance2 = 0.;
    for (unsigned int d = 0; d < 3; ++d) {
      const double outside = std::max(0., std::abs(away[d]) - cell.half[d]);
      distance2 += outside * outside;
    }
    const double far = reach + implementation->largest_gap;
    if (distance2 <= far * far)
      ranks.push_back(cell.rank);
  }
}

} // namespace eunoe
