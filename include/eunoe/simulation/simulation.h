#ifndef eunoe_simulation_simulation_h
#define eunoe_simulation_simulation_h

#include <eunoe/core/log.h>
#include <eunoe/engine/clock.h>
#include <eunoe/engine/integrator.h>
#include <eunoe/engine/load_balancer.h>
#include <eunoe/engine/moving_solids.h>
#include <eunoe/engine/particle_guard.h>
#include <eunoe/engine/particle_system.h>
#include <eunoe/engine/search_criterion.h>
#include <eunoe/engine/skin_tuner.h>
#include <eunoe/engine/sleeper.h>
#include <eunoe/simulation/checkpoints.h>
#include <eunoe/simulation/forecast.h>
#include <eunoe/simulation/inserter.h>
#include <eunoe/simulation/outputs.h>
#include <eunoe/simulation/parameters.h>
#include <eunoe/simulation/progress.h>

#include <functional>
#include <optional>

namespace eunoe {

/// One DEM simulation: owns all parts and drives them through time. Runs on any communicator, so
/// that several can live in one program.
class Simulation
{
public:
  /// Builds all parts; writes nothing. Throws a UserError on every rank if the case makes no sense.
  /// Collective, like all that follows.
  Simulation(const Parameters &parameters, MPI_Comm comm, Log &log);
  ~Simulation();

  /// What would stop or harm the run, and what else is known of it beforehand.
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

  /// @name What processes and observables read
  ///@{
  MPI_Comm communicator() const { return domain.communicator(); }
  const Parameters &get_parameters() const { return parameters; }
  double time() const { return clock.time(); }
  unsigned long long step_number() const { return clock.step(); }
  double time_step() const { return clock.time_step(); }
  const Domain &get_domain() const { return domain; }
  const ContactModel &contact_model() const { return system.contact_model(); }
  const std::vector<Solid> &get_solids() const { return solids.list(); }
  const Ledger &get_ledger() const { return system.get_ledger(); }
  const ParticleSystem &get_system() const { return system; }
  const ParticleIds &particle_ids() const { return inserter.get_ids(); }

  /// Completes the step of the integrator, so that velocities belong to the present time. To be
  /// called before particles are read; changes no result.
  const ParticleArrays &complete_step();
  /// What acts at present in all contacts of owned particles, of which one of two ranks is known to
  /// both; collective.
  std::vector<ContactForce> contact_forces();
  /// Force and torque on every solid, of all ranks; only after a step for which it was wanted.
  std::vector<SolidLoad> global_solid_loads() const;
  ///@}

  /// @name What they say and write
  ///@{
  Log &get_log() { return progress.get_log(); }
  OutputFolder &output_folder() { return outputs.folder; }
  /// Writes the particles to a series of their own, beside the regular output.
  void write_pictures(PictureSeries &series);
  ///@}

  /// @name What processes do
  ///@{
  /// Owned particles whose extra doubles (see Process::add_fields) may be changed.
  ParticleArrays &changeable_particles();
  /// Takes ids for particles of all ranks, see ParticleIds::take.
  ParticleId take_ids(std::uint64_t n) { return inserter.take_ids(n); }
  /// Inserts and removes particles at the present time; the others continue unchanged. Particles
  /// that have gone wrong are found and treated as before a search.
  void insert_and_remove(Delivery delivery, const std::vector<std::size_t> &removed);
  /// Takes note that the motion of a solid was changed at the present time.
  void renew_solids() { move_solids(); }
  ///@}

private:
  std::vector<Solid> given_solids(Problems &problems) const;
  void start();
  /// @param goes_on whether with the tables of an earlier part
  void begin_results(bool goes_on);
  /// The time step.
  void advance();
  /// Throws a UserError if the integrator does not do what forces rest on; collective.
  void check_integrator();
  void move_solids();
  void search();
  /// Whether the coming search is to be made with another skin, which is in use then; collective.
  bool tune_skin();
  /// Tells all who need it the skin that has been chosen.
  void use_skin();
  void note_search();
  /// Looks for particles with something wrong before they are shared out anew; stops the run on all
  /// ranks, or returns the rows of those to take out.
  std::vector<std::size_t> inspect();
  [[noreturn]] void stop_for(const InspectionResult &result);
  /// Determines the particles that sleep from now on.
  /// @param forces_follow in this step; otherwise it is between two steps
  void update_sleep(bool wake_all, bool forces_follow);
  void compute_forces();
  /// What happens between two steps, at the present time.
  void do_what_is_due();
  bool finished() const;
  void save(CheckpointWriter &writer);
  void resume();
  void go_on(const Checkpoint &checkpoint);
  void begin_phase(const Checkpoint &checkpoint);
  void place_domain_of(const Checkpoint &checkpoint);
  void check_guests();
  /// Writes a checkpoint if it is time or if the run was asked to stop.
  void checkpoint_if_due();
  void write_checkpoint();
  void report_progress(bool at_end);
  void write_summary();
  /// Writes measurements.csv, where something was measured.
  void write_measurements();

  const Parameters parameters;            ///< with what the process decides
  const std::unique_ptr<Process> process; ///< null for a general case
  Progress progress;
  Inserter inserter;
  Domain domain;
  Clock clock;
  Sleeper sleeper;
  ParticleSystem system;
  MovingSolids solids;
  std::unique_ptr<Integrator> integrator;
  bool is_integrator_checked = false; ///< at the first step with particles
  SearchCriterion criterion;
  std::optional<SkinTuner> tuner; ///< of the skin; none: the input gives it
  LoadBalancer balancer;
  ParticleGuard guard;
  Checkpoints checkpoints;
  Outputs outputs;
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

/// Asks the process whether it can go on with another input: it finds its solids and its progress
/// by its own subsection.
/// @param head of the checkpoint
void check_phase(const Parameters &parameters, const Problems &differences,
                 const nlohmann::ordered_json &head, Problems &problems);

/// What is wrong with parameters only in the light of the made domain and the sizes of particles.
/// @param reach least distance of two centres up to which a search must look (m)
void check_domain(const Domain &domain, const Parameters &parameters, double reach,
                  Problems &problems);

} // namespace eunoe

#endif
