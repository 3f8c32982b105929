#ifndef eunoe_processes_powder_spreading_powder_spreading_h
#define eunoe_processes_powder_spreading_powder_spreading_h

#include <eunoe/processes/powder_spreading/feed_bed.h>
#include <eunoe/processes/powder_spreading/layer_log.h>
#include <eunoe/processes/powder_spreading/schedule.h>

namespace eunoe::spreading {

/// Layer-by-layer spreading of powder: settles a bed of feedstock, then runs the passes of the
/// schedule and weighs every layer.
class PowderSpreading : public Process
{
public:
  PowderSpreading(const SpreadingParameters &parameters, const PhysicalProperties &physics)
      : p(parameters), wall_material(physics.wall_material()),
        apparatus(parameters, physics.largest_diameter())
  {
  }

  void add_fields(ParticleFields &fields) override { layer_fields = LayerLog::add_fields(fields); }
  void add_solids(std::vector<Solid> &solids) override
  {
    handles = apparatus.add_solids(solids, wall_material);
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

private:
  enum class Phase
  {
    settling_bed,   ///< the bed that is copied
    settling_stack, ///< the reservoir of the first pass, made of copies
    passes,
    done
  };

  void insert_loose_bed(Simulation &simulation);
  void fill_reservoir(Simulation &simulation, double platform_height);
  bool has_settled(Simulation &simulation);
  void go_on_after_settling(Simulation &simulation);
  void lower_platform(double time);
  void schedule_passes(double beginning);
  void step_passes(Simulation &simulation);

  const SpreadingParameters p;
  const int wall_material;
  Apparatus apparatus;
  Apparatus::SolidHandles handles;
  LayerLog::Fields layer_fields;
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
