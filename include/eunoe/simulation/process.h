#ifndef eunoe_simulation_process_h
#define eunoe_simulation_process_h

#include <eunoe/core/parameter_section.h>
#include <eunoe/core/problems.h>
#include <eunoe/core/registry.h>
#include <eunoe/simulation/measurement.h>
#include <eunoe/state/particle_field.h>

#include <memory>

namespace eunoe {

class Checkpoint;
class CheckpointWriter;
class Parameters;
class Simulation;
struct Solid;

/// What a run will cost, for `--check`.
struct RunEstimate
{
  double particles = 0.; ///< at a time, mean over the run
  double most_particles = 0.;
  double steps = 0.;
  double pictures = 0.; ///< of all particles that a process writes besides the regular ones

  double particle_steps() const { return particles * steps; }
  /// Particle-steps per second and core, as measured on settled beds with the full model: of 20,000
  /// particles, which fit into the caches, and of 200,000 to a million, which do not.
  double speed() const { return most_particles < 1e5 ? 16e6 : 8e6; }
  double core_seconds() const { return particle_steps() / speed(); }
};

/// A running experiment with its own geometry, schedule, insertion and measurements, composed from
/// the parts of the engine. Its section of the input makes it.
class Process
{
public:
  virtual ~Process() = default;

  /// Adds what the process attaches to every particle. Called once, before there are particles.
  virtual void add_fields(ParticleFields &) {}

  /// Adds the solids of the process. Called once, before the first step.
  virtual void add_solids(std::vector<Solid> &) {}

  /// Called once before the first step.
  virtual void start(Simulation &simulation) = 0;

  /// Adds all that the process keeps to a checkpoint; collective.
  virtual void save(CheckpointWriter &writer) const = 0;
  /// Called instead of `start` when the run continues from a checkpoint; collective.
  virtual void resume(Simulation &simulation, const Checkpoint &checkpoint) = 0;

  /// Called after every step. Must call Simulation::complete_step before it looks at particles.
  virtual void step(Simulation &simulation) = 0;

  /// Whether the forces on the solids are to be summed during the coming step.
  virtual bool wants_solid_loads(unsigned long long /*step*/) const { return false; }

  /// Share of the work that is done, in [0, 1], and what is being done now.
  virtual double progress(const Simulation &simulation) const = 0;
  virtual std::string stage() const { return ""; }

  /// Whether all work is done.
  virtual bool finished() const = 0;

  /// What has been measured so far, the same on every rank.
  virtual std::vector<Measurement> measurements() const { return {}; }

  /// Adds what the process has found to the keys of summary.json.
  virtual void add_to_summary(nlohmann::ordered_json &) const {}
};

/// What the input file says of a process.
class ProcessSection : public ParameterSection
{
public:
  /// What is wrong with the process together with the other parameters.
  virtual void check_with(const Parameters &parameters, const ParameterCheck &check) const = 0;

  /// What forbids to go on, with this section, from the state of a run whose section differed.
  /// @param differences what differs in this section
  /// @param head of the checkpoint, with what the process has saved
  virtual void check_phase(const std::vector<Problem> &differences,
                           const nlohmann::ordered_json & /*head*/, Problems &problems) const
  {
    for (const Problem &difference : differences)
      problems.add(difference.where, difference.what, difference.mend);
  }

  /// Whether the run of a checkpoint has come to the end of this process, so that nothing is left
  /// to simulate unless this section asks for more.
  /// @param head of the checkpoint, with what the process has saved
  virtual bool is_done(const nlohmann::ordered_json & /*head*/) const { return false; }

  /// Sets those parameters of the engine that the process decides: mesh, boundaries, end time.
  /// Throws a UserError if they are impossible.
  virtual void decide(Parameters &parameters) const = 0;

  /// What the run will cost, as far as it can be known.
  /// @param parameters with what the process decides
  virtual RunEstimate estimate(const Parameters &parameters) const = 0;

  /// Largest speed at which a solid of the process will move (m/s).
  virtual double fastest_solid() const { return 0.; }

  /// The process itself.
  /// @param parameters with what the process decides
  virtual std::unique_ptr<Process> make(const Parameters &parameters) const = 0;

  /// Number of the type of the particles that the process measures.
  virtual std::size_t powder() const { return 0; }

  /// What the process measures.
  virtual std::vector<ObservableDescription> observables() const { return {}; }

  /// Names of the files in the output folder by which the run is known and judged.
  virtual std::vector<std::string> results() const { return {}; }

  /// What the process measures of particles that were not simulated here, in its own frame, as far
  /// as their places tell it. Throws a UserError that says why they cannot be measured.
  /// @param moments the particles at every moment at which the process measures, or at the last one
  virtual std::vector<Measurement> measure(
      const Parameters & /*parameters*/,
      const std::vector<std::vector<GivenParticle>> & /*moments*/) const
  {
    throw UserError("This process cannot measure particles of others.");
  }
};

using ProcessRegistry = Registry<std::unique_ptr<ProcessSection>>;
ProcessRegistry &process_kinds();

} // namespace eunoe

#endif
