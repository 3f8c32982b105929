#ifndef eunoe_engine_particle_system_h
#define eunoe_engine_particle_system_h

#include <eunoe/contact/contact_grid.h>
#include <eunoe/contact/pair_forces.h>
#include <eunoe/core/timers.h>
#include <eunoe/engine/halo.h>
#include <eunoe/engine/ledger.h>
#include <eunoe/engine/load.h>
#include <eunoe/engine/particle_guard.h>
#include <eunoe/engine/particle_store.h>
#include <eunoe/engine/skin_tuner.h>
#include <eunoe/engine/solid_contacts.h>
#include <eunoe/engine/sparse_contacts.h>

namespace eunoe {

class Checkpoint;
class CheckpointWriter;
class SavedLayout;

/// New particles with what their contacts remember.
struct Delivery
{
  std::vector<NewParticle> particles; ///< this rank's share; ids larger than all before
  /// One row per particle, or none at all; partners are named by their new ids.
  ContactRows rows{0};
  bool has_rows = false;
};

/// What acts on the particles of a run, and what is attached to each.
struct ParticlePhysics
{
  ContactModel model;      ///< of two particles
  ContactModel wall_model; ///< of particles and solids
  std::vector<std::unique_ptr<Load>> loads;
  ParticleFields fields;
  std::optional<FieldHandle> asleep; ///< field that is not 0 for sleepers; none: nobody sleeps
  Vec3 gravity;                      ///< (m/s2)
};

/// All particles of a run and their contacts: the store of record, the arrays of the hot loop, the
/// ghosts, the lists of what can touch, and the search that rebuilds them all.
class ParticleSystem
{
public:
  /// @param skin separation up to which pairs are listed (m)
  /// @param largest_diameter of all particles ever (m)
  ParticleSystem(Domain &domain, ParticlePhysics physics, double skin, double largest_diameter,
                 Timers &timers);

  /// Lets pairs be listed up to another separation (m) from now on; `search` must come before all
  /// else. Collective.
  void set_skin(double wanted);
  /// Reach of the search over the largest diameter.
  double neighborhood_threshold() const { return 1. + skin / largest_diameter; }
  /// What the lists hold; collective.
  SearchLoad search_load() const;

  const ContactModel &contact_model() const { return physics.model; }
  const ContactModel &wall_model() const { return physics.wall_model; }
  const std::vector<std::unique_ptr<Load>> &loads() const { return physics.loads; }
  const ParticleFields &fields() const { return physics.fields; }
  const Ledger &get_ledger() const { return ledger; }

  /// Distributes the particles, exchanges ghosts and rebuilds the lists; every contact keeps its
  /// memory. Particles beyond an outlet leave. Collective.
  /// @param farthest that a particle is from its reference (m); infinite: not known
  /// @param lost rows of owned particles that are taken out and counted as lost
  void search(const std::vector<Solid> &solids, double farthest,
              const LoadBalancingParameters *balance = nullptr,
              const std::vector<std::size_t> &lost = {});

  /// Rebuilds the lists of the particles on the ranks and in the order that they have, which costs
  /// less and gives the same bits. Particles beyond an outlet leave. Collective.
  /// @param farthest, lost as for `search`
  /// @return false if only `search` will do; nothing has been done then
  bool search_again(const std::vector<Solid> &solids, double farthest,
                    const std::vector<std::size_t> &lost);

  /// How seldom this rank would list its near pairs.
  double near_share() const { return pairs.near.share(); }
  /// Particles have gone by at most so many of their paces, and by @p typical (m), infinite if that
  /// is not known.
  /// @param share largest `near_share` of a rank
  void note_step(double paces, double typical, double share)
  {
    pairs.near.note_step(paces, typical, skin, share);
  }

  /// Throws a UserError if particles of another input's checkpoint do not fit into this run;
  /// collective.
  void check_guests(const Checkpoint &checkpoint, const std::vector<Solid> &solids) const;

  /// What is wrong with this rank's particles.
  Faults inspect(const ParticleGuard &guard, const std::vector<Solid> &solids) const
  {
    return guard.inspect(particles, pairs, solid_contacts, solids);
  }
  std::string describe(std::size_t row, const std::vector<Solid> &solids) const
  {
    return describe_particle(particles, row, pairs, solid_contacts, solids);
  }

  /// Adds and removes particles, then searches. Those that stay keep their forces; the new ones
  /// have none yet. Collective.
  /// @param removed rows of owned particles
  /// @param lost rows of those that are taken out and counted as lost
  /// @param first_sharing if not null: the particles are shared out before there are lists of them,
  ///   as the owners of a few coarse cells would otherwise hold all
  /// @return the smallest id of the new particles of all ranks
  ParticleId insert_and_remove(Delivery delivery, const std::vector<std::size_t> &removed,
                               const std::vector<std::size_t> &lost,
                               const std::vector<Solid> &solids,
                               const LoadBalancingParameters *first_sharing);

  /// Brings the ghosts up to date; collective.
  void update_ghosts() { halo.update(particles); }
  /// Of this rank: those that are brought up to date.
  std::size_t n_paired_ghosts() const { return halo.n_ghosts(); }

  /// Keeps awake the neighbours of particles that leave at the coming search, as they lose their
  /// support; collective.
  /// @param lost rows of owned particles
  void stir_around_leaving(const SparseContacts &sparse, const std::vector<std::size_t> &lost,
                           unsigned long long step);

  /// Puts to sleep and wakes, then brings the ghosts up to date; collective.
  void update_sleep(const SparseContacts &sparse, const Stirring &stirring);

  /// Lets every contact begin anew.
  void forget_contacts(bool between_particles, bool with_solids);

  /// Adds the forces of the loads and of all contacts to the weights and advances the memory of the
  /// contacts by @p dt (s).
  /// @param on_solids if not null: forces on the solids, one per solid
  void add_forces(const std::vector<Solid> &solids, double time, double dt,
                  std::vector<SolidLoad> *on_solids);

  /// Adds the present forces of the contacts to @p loads, one per solid, and changes nothing else.
  void add_solid_loads(const std::vector<Solid> &solids, double time,
                       std::vector<SolidLoad> &loads) const;

  /// Computes the forces on the owned particles with ids from @p first_new on, which a scheme with
  /// an opening half step needs.
  void start_forces_on_new(ParticleId first_new, const std::vector<Solid> &solids, double time);

  /// What acts at present in all contacts of owned particles. A contact of two ranks is known to
  /// both. Velocities, of ghosts too, must belong to the present time.
  std::vector<ContactForce> contact_forces(const std::vector<Solid> &solids, double time) const;

  /// Adds all particles, with what their contacts remember and their references,
  /// and the ledger to a checkpoint; collective. Velocities must belong to the present time.
  void save(CheckpointWriter &writer) const;

  /// Takes over the particles of a checkpoint into an empty system and rebuilds the lists as the
  /// last search had left them; collective.
  /// @param solids in their places at that search
  /// @param sparse has the sleepers
  /// @param begins_phase whether the checkpoint is of another input: then the lists are those of
  ///                     the present places, and all are awake
  /// @param keeps_ledger whether the ledger goes on; else it begins with what is here
  /// @return what is lost on the way, in sentences
  std::vector<std::string> load(const Checkpoint &checkpoint, const std::vector<Solid> &solids,
                                const LoadBalancingParameters &balancing,
                                const SparseContacts &sparse, bool begins_phase, bool keeps_ledger);

  /// Memory of all contacts by owned particle.
  ContactRows contact_rows() const;

  /// Largest load of a rank less the smallest, over the mean; collective.
  double imbalance(const LoadBalancingParameters &parameters) const
  {
    return store.imbalance(parameters);
  }
  std::uint64_t n_global() const { return store.n_global(); }
  /// Of both kinds.
  unsigned long long n_searches() const { return searches; }
  unsigned long long n_searches_in_place() const { return searches_in_place; }
  unsigned long long n_balances() const { return balances; }
  std::size_t n_pairs() const { return pairs.size(); }
  const SolidContacts &get_solid_contacts() const { return solid_contacts; }
  const ParticleStore &get_store() const { return store; }

  ParticleArrays particles;

private:
  /// Distance from where the last `search` found them up to which the ghosts suffice (m): half a
  /// diameter, from two to four skins. Larger: more ghosts, fewer of the expensive searches.
  double largest_drift() const;
  /// Distance of two centres up to which ghosts are needed (m).
  double reach_of_ghosts() const;
  ContactGrid new_grid() const;
  /// The outlet through which a particle of a checkpoint has gone since its last search, -1 if
  /// none.
  int outlet_passed(const double *row) const;
  void check_guests(const Rows &rows, const std::string &path) const;
  /// What a checkpoint holds of this rank's particles.
  Rows rows_to_save() const;
  /// This rank's share of a checkpoint's particles, if they fit into this run; collective.
  const Rows &rows_of(const Checkpoint &checkpoint, const SavedLayout &layout,
                      bool begins_phase) const;
  /// Cost of every particle in a step by what it can touch, about 1 in a settled bed.
  std::vector<double> work() const;
  bool is_within_reach(std::size_t pair) const;
  /// Owned particles that are beyond an outlet, and which one.
  std::vector<std::pair<std::size_t, int>> beyond_outlets() const;
  /// Counts particles that leave through outlets, and lost particles.
  /// @return the rows of all of them
  std::vector<std::size_t> count_leaving(const std::vector<std::size_t> &lost);
  /// Gives those particles new references, at their places, that have gone by more than a
  /// quarter of what the farthest have: so a search is about what moves, and the others keep their
  /// pairs. Wraps them at periods.
  std::vector<ContactGrid::Moved> follow(double farthest);
  /// Parts particles that leave from all others: their contacts end, and a search finds no pairs of
  /// them; collective.
  /// @param moved to which they are added
  /// @return a flag for each row, ghosts too
  std::vector<std::uint8_t> cut_off(const std::vector<std::size_t> &leaving,
                                    std::vector<ContactGrid::Moved> &moved);
  /// Takes particles that have been cut off out of all that knows them by their rows.
  /// @param n owned ones of all ranks
  void leave_out(const Remaining &remaining, std::uint64_t n);
  /// Adds what the loads alone do to the particles of some rows.
  void add_loads(const std::vector<std::size_t> &rows, double time);
  /// Sorts out the pairs of two sleepers and the ghosts that sleep.
  void leave_out_sleepers();
  void rebuild(const std::vector<Solid> &solids, const LoadBalancingParameters *balance);
  /// Reserves the memory of the contacts at once, as a vector that grows by itself takes twice as
  /// much.
  void make_room_for_contacts();
  /// Reads the particles from the store and makes ghosts and empty lists.
  /// @return where the contacts of each owned particle are kept
  std::vector<Origin> build_lists(const std::vector<Solid> &solids);
  /// After pairs were found: gives back what is not needed.
  void use_pairs();

  Domain &domain;
  const ParticlePhysics physics;
  const ContactModel &model;
  const double largest_diameter;
  double skin;
  double drift = 0.; ///< at most so far has a particle moved from there (m)
  Ledger ledger;
  Timers &timers;
  ParticleStore store;
  Halo halo;
  ContactGrid grid;
  ContactGrid::Found found;
  PairForces pair_forces;
  SolidContacts solid_contacts;
  PairList pairs;
  ContactRows rows;
  const std::vector<double> extra_defaults; ///< extra doubles of a new particle
  std::size_t pairs_with_room = 0;          ///< for whose contacts there is room in the memory
  unsigned long long searches = 0, searches_in_place = 0, balances = 0;
  /// At most so far has a particle moved since the mesh followed the particles (m).
  double unadapted = 0.;
};

} // namespace eunoe

#endif
