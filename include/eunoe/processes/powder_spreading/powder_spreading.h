#ifndef eunoe_processes_powder_spreading_powder_spreading_h
#define eunoe_processes_powder_spreading_powder_spreading_h

#include <eunoe/processes/powder_spreading/feed_bed.h>
#include <eunoe/processes/powder_spreading/layer_log.h>
#include <eunoe/processes/powder_spreading/schedule.h>

#include <algorithm>

namespace eunoe::spreading {

/// Layer-by-layer spreading of powder: settles a bed of feedstock, then runs the passes of the
/// schedule and weighs every layer.
class PowderSpreading : public Process
{
public:
  void declare(dealii::ParameterHandler &prm) override { p.declare(prm); }
  void check(const ParameterCheck &check) const override { p.check(check); }
  void check_with(const Parameters &parameters, const ParameterCheck &check) const override;
  void prepare(Parameters &parameters) override;
  RunEstimate estimate(const Parameters &parameters) const override;
  std::vector<ParticleField> fields() const override { return LayerLog::fields(); }
  std::vector<Solid> make_solids(const Parameters &parameters) override
  {
    return apparatus->make_solids(parameters.physics.wall_material());
  }
  double fastest_solid() const override
  {
    // A smooth stroke is at most twice as fast as on average.
    return std::max({std::hypot(p.velocity, p.vibration_speed()),
                     2. * p.plate_velocity + recoil_speed(), 2. * p.platform_velocity});
  }
  void start(Simulation &simulation) override;
  void save(CheckpointWriter &writer) const override;
  void resume(Simulation &simulation, const Checkpoint &checkpoint) override;
  void step(Simulation &simulation) override;
  bool wants_solid_loads(unsigned long long step) const override
  {
    return pass_over_plate >= 0 && step % p.force_sampling == 0;
  }
  double progress(const Simulation &simulation) const override;
  std::string stage() const override;
  bool finished() const override { return phase == Phase::done; }
  std::vector<Measurement> measurements() const override
  {
    return layers ? layers->measurements() : std::vector<Measurement>();
  }
  std::vector<ObservableDescription> observables() const override
  {
    return LayerLog::observables();
  }

private:
  enum class Phase
  {
    settling_bed,   ///< the bed that is copied
    settling_stack, ///< the reservoir of the first pass, made of copies
    passes,
    done
  };

  /// What happens at the sides of the domain.
  void set_boundaries(Parameters &parameters) const;
  /// Largest speed at which the plate yields under the spreader (m/s).
  double recoil_speed() const
  {
    return M_PI * p.plate_recoil * p.velocity / (p.length_factor * p.w3);
  }
  void insert_loose_bed(Simulation &simulation);
  void fill_reservoir(Simulation &simulation, double platform_height);
  bool has_settled(Simulation &simulation);
  void go_on_after_settling(Simulation &simulation);
  void lower_platform(double time);
  void schedule_passes(double beginning);
  void step_passes(Simulation &simulation);
  /// Number of particles that a settled bed is expected to take.
  double bed_particles(const Parameters &parameters, double bed_depth) const;

  SpreadingParameters p;
  std::unique_ptr<Apparatus> apparatus;
  std::unique_ptr<LayerLog> layers;
  FeedBed bed;

  Phase phase = Phase::settling_bed;
  double phase_start = 0.;
  /// When the platform went down for the reservoir of the first pass (s); negative: it did not.
  double lowering = -1.;
  unsigned int n_fillings = 0;
  std::vector<Pass> passes;
  std::size_t next_feed = 0, next_weighing = 0;
  int pass_over_plate = -1;
};

} // namespace eunoe::spreading

#endif
