#include <eunoe/contact/model_parameters.h>
#include <eunoe/core/compat.h>
#include <eunoe/particles/particle_store.h>

#include <deal.II/grid/filtered_iterator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/particles/particle_handler.h>

#include "../simulation/mesh.h"

#include <algorithm>
#include <numeric>
#include <set>

namespace eunoe {

namespace {

/// Places of a particle's data among its properties in the handler.
namespace property {
constexpr unsigned int velocity = 0, spin = 3, force = 6, torque = 9, radius = 12, mass = 13,
                       type = 14, origin = 15, id = 16, work = 17, extra = 18;
} // namespace property

void store(const Vec3 &v, double *values)
{
  values[0] = v.x;
  values[1] = v.y;
  values[2] = v.z;
}

Quad load(const double *values, const double w)
{
  return {values[0], values[1], values[2], w};
}

/// A place in memory as one double, exact below 2^53.
double encode(const Origin &origin)
{
  return origin.rank < 0 ? -1. : origin.rank * 0x1p32 + origin.row;
}

Origin decode(const double code)
{
  if (code < 0.)
    return {};
  const double rank = std::floor(code / 0x1p32);
  return {static_cast<std::int32_t>(rank), static_cast<std::int32_t>(code - rank * 0x1p32)};
}

} // namespace

struct ParticleStore::Implementation
{
  using Handler = dealii::Particles::ParticleHandler<3>;

  Implementation(Domain &domain, unsigned int n_extra, int asleep)
      : domain(domain), triangulation(domain.mesh().triangulation), n_extra(n_extra),
        asleep(asleep), handler(triangulation, *domain.mesh().mapping, property::extra + n_extra)
  {
    MPI_Comm_rank(domain.communicator(), &rank);
    find_foreign_neighbours();
  }

  void find_foreign_neighbours();

  static std::vector<double> properties_of(const NewParticle &p, const Origin &origin,
                                           const std::vector<double> &extra)
  {
    std::vector<double> values(property::extra, 0.);
    store(p.velocity, &values[property::velocity]);
    store(p.spin, &values[property::spin]);
    values[property::radius] = p.radius;
    values[property::mass] = p.mass;
    values[property::type] = p.type;
    values[property::origin] = encode(origin);
    values[property::id] = p.id;
    values[property::work] = 1.;
    values.insert(values.end(), extra.begin(), extra.end());
    return values;
  }

  /// Cost of particles, as they were when they were last written.
  template <typename Range>
  double weight(const Range &particles, const LoadBalancingParameters &p) const
  {
    double sum = 0.;
    for (const auto &particle : particles) {
      const auto values = particle.get_properties();
      sum += values[property::work] * (asleep >= 0 && values[property::extra + asleep] != 0.
                                           ? p.inactive_factor
                                           : p.active_factor);
    }
    return sum * p.particle_weight;
  }

  Domain &domain;
  dealii::parallel::distributed::Triangulation<3> &triangulation;
  const unsigned int n_extra;
  const int asleep;
  Handler handler;
  int rank;

  /// A cell of another rank: its owner and its box.
  struct ForeignCell
  {
    int rank;
    Vec3 centre, half;
  };
  /// Neighbours of a cell that others own, ordered by rank, by active cell index.
  std::vector<std::vector<ForeignCell>> near_cell;
  /// The particles of the last read and their cells, in the order of the arrays.
  std::vector<Handler::particle_iterator> particles;
  std::vector<unsigned int> cells;
};

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

ParticleStore::ParticleStore(Domain &domain, const unsigned int n_extra, const int asleep)
    : implementation(std::make_unique<Implementation>(domain, n_extra, asleep))
{
}

ParticleStore::~ParticleStore() = default;

std::uint64_t ParticleStore::n_global() const
{
  return implementation->handler.n_global_particles();
}

void ParticleStore::insert(const std::vector<NewParticle> &particles,
                           const std::vector<double> &extra, const std::vector<Origin> &origins)
{
  Implementation &impl = *implementation;
  MPI_Comm comm = impl.domain.communicator();
  // Refused here, as the search for the cells of such points does not come back.
  const std::uint64_t outside = dealii::Utilities::MPI::sum(
      static_cast<std::uint64_t>(
          std::count_if(particles.begin(), particles.end(),
                        [&](const NewParticle &p) { return !impl.domain.contains(p.position); })),
      comm);
  if (outside > 0)
    throw UserError("Of the particles to insert, " + std::to_string(outside) +
                    " lie outside the mesh. Enlarge the mesh or move the place of insertion.");

  const auto owned = dealii::IteratorFilters::LocallyOwnedCell();
  const auto boxes = dealii::Utilities::MPI::all_gather(
      comm,
      dealii::GridTools::compute_mesh_predicate_bounding_box(
          impl.triangulation,
          std::function<bool(const dealii::Triangulation<3>::active_cell_iterator &)>(owned)));
  const std::uint64_t expected =
      n_global() + dealii::Utilities::MPI::sum(static_cast<std::uint64_t>(particles.size()), comm);
  // In portions, as each is copied several times on its way.
  constexpr std::size_t portion = 50000;
  const std::size_t most =
      dealii::Utilities::MPI::max(static_cast<std::uint64_t>(particles.size()), comm);
  for (std::size_t begin = 0; begin < most; begin += portion) {
    std::vector<dealii::Point<3>> positions;
    std::vector<std::vector<double>> properties;
    for (std::size_t k = begin; k < std::min(begin + portion, particles.size()); ++k) {
      const NewParticle &p = particles[k];
      positions.push_back(to_point(impl.domain.periods().wrap(p.position)));
      properties.push_back(impl.properties_of(p, origins.empty() ? Origin() : origins[k], extra));
    }
    // Ids go with the properties: given apart, they are exchanged only among ranks that have
    // particles to insert, and these wait for the others forever (deal.II 9.4).
    impl.handler.insert_global_particles(positions, boxes, properties);
  }
  for (auto particle = impl.handler.begin(); particle != impl.handler.end(); ++particle)
    particle->set_id(
        static_cast<dealii::types::particle_index>(particle->get_properties()[property::id]));
  if (n_global() != expected)
    throw std::logic_error("the mesh did not take over all inserted particles");
}

void ParticleStore::write(const ParticleArrays &particles, const std::vector<double> &work)
{
  Implementation &impl = *implementation;
  const PeriodicBox &box = impl.domain.periods();
  for (std::size_t row = 0; row < particles.n_owned; ++row) {
    auto &particle = *impl.particles[row];
    particle.set_location(to_point(box.wrap(particles.position[row].vec())));
    const auto values = particle.get_properties();
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
    return parameters.cell_weight +
           static_cast<unsigned int>(impl.weight(impl.handler.particles_in_cell(cell), parameters));
  });
  impl.handler.prepare_for_coarsening_and_refinement();
  impl.triangulation.repartition();
  impl.handler.unpack_after_coarsening_and_refinement();
  connection.disconnect();
  impl.find_foreign_neighbours();
  impl.particles.clear();
}

double ParticleStore::imbalance(const LoadBalancingParameters &parameters) const
{
  const Implementation &impl = *implementation;
  const double load = static_cast<double>(parameters.cell_weight) *
                          impl.triangulation.n_locally_owned_active_cells() +
                      impl.weight(impl.handler, parameters);
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
    entries.push_back({grid.key(to_vec3(particle->get_location())),
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
    const Vec3 x = to_vec3(entry.particle->get_location());
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

unsigned int ParticleStore::cell(const std::size_t row) const
{
  return implementation->cells[row];
}

void ParticleStore::ranks_near(const std::size_t row, const Vec3 &position, const double reach,
                               std::vector<int> &ranks) const
{
  const PeriodicBox &box = implementation->domain.periods();
  ranks.clear();
  for (const auto &cell : implementation->near_cell[implementation->cells[row]]) {
    if (!ranks.empty() && ranks.back() == cell.rank)
      continue;
    const Vec3 away = box.shortest(position - cell.centre);
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
