#ifndef eunoe_simulation_simulation_h
#define eunoe_simulation_simulation_h

#include <eunoe/checkpoint/checkpoint_store.h>
#include <eunoe/core/log.h>
#include <eunoe/engine/integrator.h>
#include <eunoe/engine/load.h>
#include <eunoe/engine/particle_system.h>
#include <eunoe/simulation/forecast.h>
#include <eunoe/simulation/observable.h>
#include <eunoe/simulation/output_folder.h>
#include <eunoe/simulation/parameters.h>
#include <eunoe/state/particle_ids.h>

#include <functional>

namespace eunoe {

/// One DEM simulation: owns all parts and drives them through time. Runs on any communicator, so
/// that several can live in one program.
class Simulation
{
public:
  /// What a simulation is made for.
  enum class Purpose
  {
    run,
    check ///< to be asked what it would do; a mesh of boxes is only sketched
  };

  /// Builds all parts; writes nothing. Throws a UserError on every rank if the case makes no sense.
  /// Collective, like all that follows.
  Simulation(Parameters &parameters, MPI_Comm comm, Log &log, Purpose purpose = Purpose::run);
  ~Simulation();

  /// What the run would stumble over, and what else is known of it beforehand.
  /// @param writes whether it would write pictures, tables and checkpoints
  Forecast foresee(bool writes = true) const;

  /// What the run will cost, as far as it can be known.
  RunEstimate estimate() const;

  /// Creates the output folder and the tables of the observables. Throws like the constructor. A
  /// run without it writes nothing.
  void open_output();

  /// Makes the observables without any output, so that they can be asked what they measure.
  void make_observables();

  /// Runs to the end and leaves all results in the output folder.
  /// @param look called before the first step and after every step, for tests and other programs
  /// @return false if the run was asked to stop earlier and has left a checkpoint
  bool run(const std::function<void(Simulation &)> &look = {});

  /// All that the process and the observables have measured so far, the same on every rank, and
  /// what those observables are.
  std::vector<Measurement> measurements() const;
  std::vector<ObservableDescription> described_observables() const;

  /// Writes the complete state to a file which is the same on any number of ranks; collective.
  void dump(const std::string &path);

  /// @name For processes and observables
  ///@{
  MPI_Comm communicator() const { return comm; }
  const Parameters &get_parameters() const { return parameters; }
  Log &get_log() { return log; }
  double time() const { return present_time; }
  unsigned long long step_number() const { return step; }
  double time_step() const { return parameters.control.time_step; }
  const Domain &get_domain() const { return domain; }
  const ContactModel &contact_model() const { return model; }
  const std::vector<Solid> &get_solids() const { return solids; }
  /// Number of a solid by its name, -1 if there is none.
  int find_solid(const std::string &name) const;
  const Ledger &get_ledger() const { return ledger; }
  ParticleSystem &get_system() { return system; }

  /// Finishes what the integrator put off, so that velocities belong to the present time. To be
  /// called before particles are looked at; changes no result.
  const ParticleArrays &complete_step();
  /// Owned particles whose extra doubles (see Process::fields) may be changed.
  ParticleArrays &changeable_particles();

  /// What acts at present in all contacts of owned particles, of which one of two ranks is known to
  /// both; collective.
  std::vector<ContactForce> contact_forces();

  /// Adds and removes particles at the present time; those that stay go on as if nothing had been.
  /// Particles that have gone wrong are found and treated as before a search.
  void exchange(const Delivery &delivery, const std::vector<std::size_t> &removed);
  /// Takes note that the motion of a solid was changed at the present time.
  void renew_solids() { move_solids(); }
  /// From which new particles take theirs.
  ParticleIds &particle_ids() { return ids; }

  /// Force and torque on every solid, of all ranks; only after a step for which it was wanted.
  std::vector<SolidLoad> global_solid_loads() const;

  /// Writes the particles to a series of their own, beside the regular output.
  void write_pictures(PictureSeries &series);
  OutputFolder &output_folder() { return output; }
  ///@}

private:
  void print_overview();
  void start();
  void find_checkpoint(Problems &problems);
  void save(CheckpointWriter &writer);
  void resume_output();
  void resume();
  /// Takes over what the head of a checkpoint holds, without the process.
  void take_over(const nlohmann::ordered_json &head);
  /// Writes a checkpoint if it is time or if the run was asked to stop.
  void checkpoint_if_due();
  void advance();
  void compute_forces(double dt);
  void move_solids();
  void ask_for_search(double moved2);
  /// Whether it is, once all ranks have answered.
  bool search_is_due();
  /// Looks for particles with something wrong before they are shared out anew; stops the run on all
  /// ranks, or returns the rows of those to take out.
  std::vector<std::size_t> inspect();
  /// Largest speed of a wall or of a solid of the process, as far as it can be known (m/s).
  double fastest_wall() const;
  /// Warns once if the stiffest contact is too fast for the time step; collective.
  void compare_time_step(double stiffest);
  [[noreturn]] void stop_for(const std::string &first, std::uint64_t number);
  const LoadBalancingParameters *balance_if_due();
  /// Whether a solid has begun to move, has come or gone since the last look at who sleeps.
  bool solid_starts() const;
  /// Looks at who sleeps from now on.
  void update_sleep(bool wake_all);
  void insert_if_due();
  void do_what_is_due();
  void report_progress(bool at_end);
  bool finished() const;
  void write_summary();
  /// Writes measurements.csv, where something was measured.
  void write_measurements();

  Parameters &parameters;
  MPI_Comm comm;
  Log &log;
  const double start_of_run;
  std::unique_ptr<Insertion> insertion; ///< null for a process, which makes its own
  const double largest_diameter;
  const double skin;
  Domain domain;
  const ContactModel model;
  const ParticleGuard guard;
  const std::vector<ParticleField> fields;
  const SparseContacts sparse;
  Ledger ledger;
  Timers timers;
  ParticleSystem system;
  std::vector<Solid> solids;
  std::vector<RigidState> solids_at_search;
  /// When it was decided who sleeps, and where the solids were then.
  struct
  {
    double time = 0.;
    std::vector<RigidState> solids;
  } last_look;
  std::vector<std::unique_ptr<Load>> loads;
  std::unique_ptr<Integrator> integrator;
  std::map<std::string, std::unique_ptr<Observable>> observable_list;
  std::vector<SolidLoad> solid_loads;
  OutputFolder output;
  std::shared_ptr<PictureSeries> particle_pictures, solid_pictures;
  CheckpointStore checkpoints;
  std::unique_ptr<Checkpoint> checkpoint; ///< from which the run continues

  /// Largest sum of the displacements of two bodies before the next search (m).
  const double allowed_displacement;
  double largest_displacement = 0.; ///< of a particle since the last search, on any rank (m)
  MPI_Request answer = MPI_REQUEST_NULL;
  unsigned long long step = 0;
  double present_time = 0.;
  double next_output = 0.;
  bool balanced_once = false;
  std::size_t n_insertions = 0;
  ParticleIds ids;
  unsigned long long first_step = 0; ///< of this part of the run
  double last_checkpoint = 0.;       ///< by the wall clock (s)
  bool stopped = false, warned_of_stiffness = false;
  unsigned long long last_reported_step = 0;
  unsigned long long last_balance = 0;
  std::uint64_t n_particles = 0;
  double share_before = -1.;  ///< of the run that was done before this part, once it is known
  double sleeping_steps = 0.; ///< steps that this rank's particles have slept, summed
  double particle_steps = 0., loop_seconds = 0., last_report = 0., reported_particle_steps = 0.;
};

/// Notes a problem if particles are to be inserted outside the mesh; collective.
/// @param places of this rank's share (m)
void check_places(const Domain &domain, const std::vector<Vec3> &places, MPI_Comm comm,
                  Problems &problems);

/// Notes a problem if one of the first @p n_given solids passes through one of the others at the
/// beginning, those of a process.
void check_crossings(const std::vector<Solid> &solids, std::size_t n_given, Problems &problems);

/// Gives walls and solids the materials that the input names for them.
void give_materials(std::vector<Solid> &solids, const PhysicalProperties &physics,
                    Problems &problems);

/// What is wrong with parameters only in the light of the made domain and the sizes of particles.
/// @param reach of the contact search (m)
void check_domain(const Domain &domain, const Parameters &parameters, double reach,
                  Problems &problems);

} // namespace eunoe

#endif
