#ifndef eunoe_source_engine_particle_store_implementation_h
#define eunoe_source_engine_particle_store_implementation_h

// The deal.II side of ParticleStore, for source files only.

#include <eunoe/core/expressions.h>
#include <eunoe/domain/cell_locator.h>
#include <eunoe/domain/mesh.h>
#include <eunoe/engine/load_balancing.h>
#include <eunoe/engine/particle_store.h>

#include <deal.II/particles/particle_handler.h>

#include <cmath>
#include <memory>
#include <vector>

namespace eunoe {

/// Places of a particle's data among its properties in the handler. Behind the extra doubles comes
/// the position, in meshes where the handler is told that of the cell's centre instead.
namespace property {
constexpr unsigned int velocity = 0, spin = 3, force = 6, torque = 9, radius = 12, mass = 13,
                       type = 14, origin = 15, id = 16, work = 17, extra = 18;
} // namespace property

inline void store(const Vec3 &v, double *values)
{
  values[0] = v.x;
  values[1] = v.y;
  values[2] = v.z;
}

inline Quad load(const double *values, const double w)
{
  return {values[0], values[1], values[2], w};
}

/// A place in memory as one double, exact below 2^53.
inline double encode(const Origin &origin)
{
  return origin.rank < 0 ? -1. : origin.rank * 0x1p32 + origin.row;
}

inline Origin decode(const double code)
{
  if (code < 0.)
    return {};
  const double rank = std::floor(code / 0x1p32);
  return {static_cast<std::int32_t>(rank), static_cast<std::int32_t>(code - rank * 0x1p32)};
}

struct ParticleStore::Implementation
{
  using Handler = dealii::Particles::ParticleHandler<3>;

  Implementation(Domain &domain, unsigned int n_extra, std::optional<FieldHandle> asleep)
      : domain(domain), triangulation(domain.mesh().triangulation), n_extra(n_extra),
        asleep(asleep),
        locator(domain.mesh().is_plain ? nullptr : std::make_unique<CellLocator>(domain)),
        handler(triangulation, *domain.mesh().mapping,
                property::extra + n_extra + (locator ? 3 : 0))
  {
    MPI_Comm_rank(domain.communicator(), &rank);
    look_at_cells();
  }

  /// Called after load balancing.
  void look_at_cells()
  {
    if (locator)
      locator->rebuild();
    find_foreign_neighbours();
  }

  void find_foreign_neighbours();
  /// Measures the distances of particles from their cells, which must be small; collective.
  void measure_gaps(const ParticleArrays &arrays);

  std::vector<double> properties_of(const NewParticle &p, const Origin &origin,
                                    const std::vector<double> &extra) const
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
    if (locator) {
      const Vec3 x = domain.periods().wrap(p.position);
      values.insert(values.end(), {x.x, x.y, x.z});
    }
    return values;
  }

  template <typename Particle>
  Vec3 position_of(const Particle &particle) const
  {
    if (!locator)
      return to_vec3(particle.get_location());
    const auto values = particle.get_properties();
    return load(&values[property::extra + n_extra], 0.).vec();
  }

  /// Inserts particles by their properties, with deal.II's search for their cells or our own;
  /// collective.
  ///@{
  void insert_by_handler(const std::vector<std::vector<double>> &properties,
                         const std::vector<NewParticle> &particles);
  void insert_by_locator(const std::vector<std::vector<double>> &properties);
  ///@}
  /// Of rows of properties that all ranks have, inserts those whose positions stick out least of
  /// one of this rank's cells; collective.
  void take_best_fitting(const std::vector<double> &rows);

  /// Cost of particles, as they were when they were last written.
  template <typename Range>
  double weight(const Range &particles, const LoadBalancingParameters &p) const
  {
    double sum = 0.;
    for (const auto &particle : particles) {
      const auto values = particle.get_properties();
      sum += values[property::work] * (asleep && values[property::extra + asleep->first] != 0.
                                           ? p.inactive_factor
                                           : p.active_factor);
    }
    return sum * p.particle_weight;
  }

  /// Cost of a cell.
  double cell_weight(const Vec3 &centre, const LoadBalancingParameters &p)
  {
    // Sums of costs must fit into 32 bits.
    constexpr double most = 1e6;
    if (p.cell_weight_expression.empty())
      return p.cell_weight;
    if (!cell_weights)
      cell_weights =
          std::make_unique<const Expressions>(p.cell_weight_expression, p.cell_weight_constants, 1);
    return std::min(most, std::max(1., cell_weights->value(0, centre, 0.)));
  }

  Domain &domain;
  dealii::parallel::distributed::Triangulation<3> &triangulation;
  const unsigned int n_extra;
  const std::optional<FieldHandle> asleep;
  const std::unique_ptr<CellLocator> locator; ///< null where the handler finds the cells itself
  Handler handler;
  int rank;
  std::unique_ptr<const Expressions> cell_weights;
  double largest_gap = 0.; ///< between a particle and the box around its cell (m)

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

} // namespace eunoe

#endif
