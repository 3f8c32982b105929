#ifndef eunoe_engine_halo_h
#define eunoe_engine_halo_h

#include <eunoe/contact/contact_grid.h>
#include <eunoe/contact/pair_list.h>
#include <eunoe/engine/particle_store.h>

#include <map>
#include <mpi.h>

namespace eunoe {

/// Ghosts, copies of other ranks' particles: which rank needs which, and their update in every
/// step.
class Halo
{
public:
  explicit Halo(MPI_Comm comm) : comm(comm) {}

  /// Appends the ghosts to freshly read arrays, ordered by (cell of @p grid, id); collective.
  /// @param separation up to which particles become ghosts (m)
  void build(ParticleArrays &particles, const ParticleStore &store, const ContactGrid &grid,
             double separation);

  /// Brings all ghosts of the last `build` up to date, their references too, and receives all of
  /// them from now on; collective.
  /// @param moved to which ghosts are added that have another reference than before
  void update_all(ParticleArrays &particles, std::vector<ContactGrid::Moved> &moved);

  /// Takes particles out, of which all ranks that have a copy know.
  void leave_out(const Remaining &remaining);

  /// From now on receives only ghosts of pairs, about half of them; collective.
  void leave_out_unpaired(const ParticleArrays &particles, const PairList &pairs);

  /// Number of ghosts that are received, asleep or awake.
  std::size_t n_ghosts() const;

  /// Brings position, velocity and spin of the ghosts up to date; collective.
  void update(ParticleArrays &particles);

  /// Gives those ghosts that are in pairs the flags of their originals; the vector has one for each
  /// particle. Collective.
  void update(std::vector<std::uint8_t> &flags);

  /// From now on receives sleepers again.
  void include_sleepers();
  /// From now on leaves out sleepers, whose state does not change.
  void leave_out_sleepers(const ParticleArrays &particles);

private:
  struct Neighbour
  {
    int rank;
    std::vector<std::int32_t> sent;     ///< rows of owned particles
    std::vector<std::int32_t> received; ///< rows of ghosts
    /// Those that are awake.
    std::vector<std::int32_t> sent_awake, received_awake;
    std::vector<double> out, in;
  };

  /// Rows of owned particles that other ranks need, by rank; collective.
  std::map<int, std::vector<std::int32_t>> rows_near(const ParticleArrays &particles,
                                                     const ParticleStore &store,
                                                     double separation) const;
  /// Makes the neighbours and sends them all that they need to know of these rows; collective.
  void send_new(const ParticleArrays &particles,
                const std::map<int, std::vector<std::int32_t>> &rows);
  /// Appends the ghosts that have come to the arrays, in their order.
  void append_received(ParticleArrays &particles, const ContactGrid &grid);
  /// Likewise of all ghosts.
  void update_references(ParticleArrays &particles, std::vector<ContactGrid::Moved> &moved);
  /// Sends `out` to and fills `in` from every neighbour; both have their sizes already.
  void exchange(int tag);

  MPI_Comm comm;
  std::vector<Neighbour> neighbours; ///< with the ghosts of pairs
  std::vector<Neighbour> everyone;   ///< with all ghosts
};

} // namespace eunoe

#endif
