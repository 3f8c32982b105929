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
  double reservoir_depth() const;
  void schedule_passes(double beginning);
  void step_passes(Simulation &simulation);
  const ParticleType &feedstock(const Simulation &simulation) const
  {
    return simulation.get_parameters().physics.types[p.particle_type];
  }

  /// @name A series of layers on those of an earlier run: series.cc
  ///@{
  void begin_series(double time, unsigned int n_layers_so_far, double platform_height);
  void set_out_series();
  void empty_reservoir(Simulation &simulation);
  nlohmann::ordered_json save_series() const;
  void load_series(const nlohmann::ordered_json &saved);
  ///@}

  const SpreadingParameters p;
  const int wall_material;
  Apparatus apparatus;
  Apparatus::SolidHandles handles;
  LayerLog::Fields layer_fields;
  std::unique_ptr<LayerLog> layers;
  FeedBed bed;

  /// The layers that this run spreads, if others lie on the plate.
  struct Series
  {
    unsigned int first_layer = 0;
    double start = 0.;           ///< (s)
    double platform_height = 0.; ///< at the start (m)
    /// When what was left of the old feedstock was taken out (s); negative: not yet.
    double emptying = -1.;
  };

  Series series;
  Phase phase = Phase::settling_bed;
  double phase_start = 0.;
  /// When the platform went down for the reservoir of the first pass (s); negative: it did not.
  double lowering = -1.;
  unsigned int n_fillings = 0;
  std::vector<Pass> passes;
  double last_platform_height = 0.; ///< after all passes (m)
  std::size_t next_feed = 0, next_weighing = 0;
  int pass_over_plate = -1;
};

} // namespace eunoe::spreading

#endif
