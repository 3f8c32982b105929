#ifndef eunoe_source_engine_particle_store_implementation_h
#define eunoe_source_engine_particle_store_implementation_h

// The deal.II side of ParticleStore, for source files only.

#include <eunoe/core/expressions.h>
#include <eunoe/domain/mesh.h>
#include <eunoe/engine/forest.h>
#include <eunoe/engine/load_balancing.h>
#include <eunoe/engine/particle_store.h>

#include <deal.II/particles/particle_handler.h>

#include <cmath>
#include <map>
#include <memory>
#include <vector>

namespace eunoe {

/// Places of a particle's data among its properties in the handler. The position is one of them, as
/// the handler is told the centre of a lattice cell instead.
namespace property {
constexpr unsigned int position = 0, velocity = 3, spin = 6, force = 9, torque = 12, radius = 15,
                       mass = 16, type = 17, origin = 18, id = 19, work = 20, extra = 21;
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

  Implementation(const Domain &domain, double least_width, double reach, unsigned int n_extra,
                 std::optional<FieldHandle> asleep)
      : domain(domain), forest(domain, least_width), reach(reach), n_extra(n_extra), asleep(asleep),
        handler(forest.mesh(), forest.get_mapping(), property::extra + n_extra),
        rank(dealii::Utilities::MPI::this_mpi_process(domain.communicator())),
        near_cell(forest.foreign_neighbours(reach))
  {
  }

  Forest::Place place_of(const Vec3 &position) const
  {
    return forest.place(domain.to_own_frame(position));
  }

  std::vector<double> properties_of(const NewParticle &p, const Origin &origin,
                                    const std::vector<double> &extra) const
  {
    std::vector<double> values(property::extra, 0.);
    store(domain.periods().wrap(p.position), &values[property::position]);
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

  /// Gives particles to the ranks that own their places, by their properties; collective. The
  /// handler's numbers are to be updated afterwards.
  /// @param rows the properties of one particle after another, by rank
  void hand_over(std::map<unsigned int, std::vector<double>> &rows);
  /// Takes particles into this rank's cells.
  void take(const std::vector<double> &rows);

  /// This rank's cells that have many particles, and parents of cells that have few.
  struct Marks
  {
    std::vector<Forest::ActiveCell> crowded;
    std::vector<Forest::Cell> sparse;
    std::uint64_t n_crowded = 0; ///< particles in crowded cells
  };
  Marks marks() const;
  /// Whether a change of the mesh pays, by numbers of all ranks.
  /// @param crowded particles in cells that would be refined
  /// @param unitable cells that would be united
  bool pays(std::uint64_t crowded, std::uint64_t unitable) const;
  /// Flags cells to be refined or united if that pays; collective.
  bool mark_cells();
  /// Lets the handler follow a change of the mesh.
  template <typename Change>
  void change_mesh(const Change &change)
  {
    handler.prepare_for_coarsening_and_refinement();
    change(forest.mesh());
    handler.unpack_after_coarsening_and_refinement();
    near_cell = forest.foreign_neighbours(reach);
    particles.clear();
  }

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

  const Domain &domain;
  Forest forest;
  const double reach; ///< largest distance at which a rank's cell may need a particle (m)
  const unsigned int n_extra;
  const std::optional<FieldHandle> asleep;
  Handler handler;
  const unsigned int rank;
  std::unique_ptr<const Expressions> cell_weights;
  /// Cells of all ranks with few particles that could not be united when this was last tried.
  std::uint64_t cannot_be_united = 0;
  /// What others own around each cell, by active index.
  std::vector<std::vector<Forest::ForeignCell>> near_cell;
  /// The particles of the last read and their cells, in the order of the arrays.
  std::vector<Handler::particle_iterator> particles;
  std::vector<unsigned int> cells;
};

} // namespace eunoe

#endif
