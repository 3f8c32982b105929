#ifndef eunoe_engine_particle_store_h
#define eunoe_engine_particle_store_h

#include <eunoe/contact/contact_grid.h>
#include <eunoe/domain/domain.h>
#include <eunoe/engine/contact_rows.h>
#include <eunoe/state/new_particle.h>

#include <functional>
#include <optional>

namespace eunoe {

struct LoadBalancingParameters;

/// Which rank and which cell have which particles: deal.II's ParticleHandler on a p4est forest, a
/// mesh of the engine's own. The handler moves no more than a particle's id and where its state is
/// kept, in the ParticleArrays with which the simulation computes: after `write` the particles find
/// their ranks and cells, and `read` brings their states there.
class ParticleStore
{
public:
  /// @param least_width of the mesh's cells (m)
  /// @param reach largest one that `ranks_near` is asked for (m)
  /// @param n_extra doubles per particle beside those of the engine
  /// @param asleep field that is not 0 for sleepers; none: nobody sleeps
  ParticleStore(const Domain &domain, double least_width, double reach, unsigned int n_extra,
                std::optional<FieldHandle> asleep);
  ~ParticleStore();

  /// From now on `ranks_near` is asked for up to another reach (m).
  void set_reach(double reach);

  /// Numbers of all ranks: particles, and cells of the mesh that distributes them.
  ///@{
  std::uint64_t n_global() const;
  std::uint64_t n_cells() const;
  ///@}

  /// Takes the state of the owned particles, which must be those of the last `read` that have not
  /// been left out, from these
  /// arrays, which must stay as they are until the next `read`. Their contacts are kept in row k of
  /// this rank.
  /// @param work cost of each in a step, about 1; new particles count 1
  void write(const ParticleArrays &particles, const std::vector<double> &work);

  /// Inserts this rank's share of new particles, wherever they lie; collective. To be called after
  /// `write`, if there are others, and once before the next `read`.
  /// @param extra initial values of the extra doubles of every particle
  /// @param contacts where those of each are kept, empty for none
  /// Throws a UserError if one of them lies outside the mesh.
  void insert(std::vector<NewParticle> &&particles, const std::vector<double> &extra,
              std::vector<Origin> &&contacts = {});

  /// Takes owned particles out of the rows, in which they are from now on those of the arrays that
  /// the next `write` has; the handler keeps them until then.
  /// @param n of all ranks
  void leave_out(const Remaining &remaining, std::uint64_t n);

  /// Removes owned particles by their rows in the arrays that were written, and those that have
  /// been left out; collective. To be called between `write` and `migrate`.
  void remove(const std::vector<std::size_t> &rows);

  /// Hands every particle to the rank that owns its cell; collective.
  void migrate();

  /// Makes the cells finer where there are many particles and coarser where there are few;
  /// collective.
  void adapt();

  /// Shares out the cells anew by their loads; collective.
  void repartition(const LoadBalancingParameters &parameters);

  /// Largest load of a rank less the smallest, over the mean; collective.
  double imbalance(const LoadBalancingParameters &parameters) const;

  /// Fills the arrays with the owned particles, ordered by (cell of @p grid where the reference is,
  /// id), without ghosts; collective. They may be those that were written.
  /// @param contacts where those of each are kept
  void read(ParticleArrays &particles, const ContactGrid &grid, std::vector<Origin> &contacts);

  /// Ranks that need a copy of an owned particle by its row in the last `read`: those that own a
  /// place within reach, across periodic faces too.
  /// @param reference of the particle as it was read
  /// @param reach distance up to which it can meet the centres of others (m)
  /// @param ranks ascending
  void ranks_near(std::size_t row, const Vec3 &reference, double reach,
                  std::vector<int> &ranks) const;

private:
  struct Implementation;
  class States;
  std::unique_ptr<Implementation> implementation;
};

} // namespace eunoe

#endif
