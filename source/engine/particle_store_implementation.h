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

/// What the handler keeps of a particle beside its id: where its state is, and what decides the
/// load of its cell. The handler is told the centre of a lattice cell as its position.
namespace property {
constexpr unsigned int origin = 0, work = 1, asleep = 2, n = 3;
} // namespace property

/// A place in memory as one double, exact below 2^53: for 2^21 ranks.
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
        handler(forest.mesh(), forest.get_mapping(), property::n),
        rank(dealii::Utilities::MPI::this_mpi_process(domain.communicator())),
        near_cell(forest.foreign_neighbours(reach))
  {
  }

  Forest::Place place_of(const Vec3 &position) const
  {
    return forest.place(domain.to_own_frame(position));
  }

  /// @name The state of the particles while they find their ranks and cells
  /// It stays where it is until the next `read`, on the rank and in the row that the origin names:
  /// rows of the arrays that were written, behind which stand new particles.
  ///@{
  const ParticleArrays *written = nullptr;
  std::vector<NewParticle> incoming;
  std::vector<Origin> incoming_contacts; ///< empty: they have none
  std::vector<double> incoming_extra;    ///< extra doubles of each

  std::size_t n_written() const { return written != nullptr ? written->n_owned : 0; }
  bool is_new(std::int32_t row) const { return static_cast<std::size_t>(row) >= n_written(); }
  const NewParticle &new_one(std::int32_t row) const { return incoming[row - n_written()]; }
  /// Rows of those that the handler has, by their rows in the last `read`; empty if none has been
  /// left out since.
  std::vector<std::int32_t> rows_now;
  std::uint64_t n_left_out = 0; ///< by all ranks
  /// Reference, which is that by which a particle finds its cell.
  Vec3 reference(std::int32_t row) const;
  ///@}

  /// The particles in the order of the arrays, by their numbers in that of the handler.
  std::vector<std::uint32_t> order(const States &states, const ContactGrid &grid);

  /// A particle that goes to a cell, in doubles: lattice cell, id, properties.
  static constexpr std::size_t traveller_size = 4 + property::n;
  static void append_traveller(const Forest::Place &place, ParticleId id, const double *properties,
                               std::vector<double> &travellers);
  /// Gives particles to the ranks that own their places; collective. The handler's numbers are to
  /// be updated afterwards.
  void hand_over(std::map<unsigned int, std::vector<double>> &travellers);
  /// Takes particles into this rank's cells.
  void take(const std::vector<double> &travellers);

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
  }

  /// Cost of particles, as they were when they were last written.
  template <typename Range>
  double weight(const Range &particles, const LoadBalancingParameters &p) const
  {
    double sum = 0.;
    for (const auto &particle : particles) {
      const auto values = particle.get_properties();
      sum += values[property::work] *
             (values[property::asleep] != 0. ? p.inactive_factor : p.active_factor);
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
  double reach; ///< largest distance at which a rank's cell may need a particle (m)
  const unsigned int n_extra;
  const std::optional<FieldHandle> asleep;
  Handler handler;
  const unsigned int rank;
  std::unique_ptr<const Expressions> cell_weights;
  /// Cells of all ranks with few particles that could not be united when this was last tried.
  std::uint64_t cannot_be_united = 0;
  /// What others own around each cell, by active index.
  std::vector<std::vector<Forest::ForeignCell>> near_cell;
  /// The cells of the particles of the last read, in the order of the arrays.
  std::vector<unsigned int> cells;
};

} // namespace eunoe

#endif
