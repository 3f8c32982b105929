#ifndef eunoe_processes_heap_heap_h
#define eunoe_processes_heap_heap_h

#include <eunoe/processes/heap/measurement.h>

namespace eunoe::heap {

/// The heap instrument: powder settles in a tube that stands on a disc, the tube is lifted, and
/// when all is at rest the heap on the disc is measured.
class Heap : public Process
{
public:
  void declare(dealii::ParameterHandler &prm) override { p.declare(prm); }
  void check(const ParameterCheck &check) const override { p.check(check); }
  void check_with(const Parameters &parameters, const ParameterCheck &check) const override;
  void prepare(Parameters &parameters) override;
  RunEstimate estimate(const Parameters &parameters) const override;
  std::vector<Solid> make_solids(const Parameters &parameters) override
  {
    return apparatus->make_solids(parameters.physics.wall_material());
  }
  void start(Simulation &simulation) override;
  void save(CheckpointWriter &writer) const override;
  void resume(Simulation &simulation, const Checkpoint &checkpoint) override;
  void step(Simulation &simulation) override;
  bool wants_solid_loads(unsigned long long) const override { return false; }
  double progress(const Simulation &simulation) const override;
  std::string stage() const override;
  bool finished() const override { return phase == Phase::done; }
  void add_to_summary(nlohmann::ordered_json &summary) const override
  {
    summary.update(results.keys);
  }
  std::vector<Measurement> measurements() const override { return results.measured; }
  std::vector<ObservableDescription> observables() const override { return heap::observables(); }

private:
  enum class Phase
  {
    filling,
    lifting,
    resting,
    done
  };

  /// Expected durations of filling, lifting and coming to rest (s).
  std::array<double, 3> expected_durations() const;
  /// Of its lower end (m).
  double height_of_tube(const Simulation &simulation) const
  {
    return p.gap + apparatus->tube->at(simulation.time()).centre.y;
  }
  void fill(Simulation &simulation);
  bool is_at_rest(Simulation &simulation);
  void begin_lifting(Simulation &simulation);
  void finish(Simulation &simulation);

  HeapParameters p;
  std::unique_ptr<Apparatus> apparatus;
  double gravity = 0.; ///< (m/s2)

  Phase phase = Phase::filling;
  double phase_start = 0.;                ///< (s)
  double calm_since = -1.;                ///< (s); negative: the powder moves
  double lift_start = -1., lift_way = 0.; ///< (s), (m); negative: not lifted yet
  Findings results;
};

} // namespace eunoe::heap

#endif
