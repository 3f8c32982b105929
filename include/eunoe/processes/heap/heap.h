#ifndef eunoe_processes_heap_heap_h
#define eunoe_processes_heap_heap_h

#include <eunoe/checkpoint/head_values.h>
#include <eunoe/processes/heap/measurement.h>

namespace eunoe::heap {

/// The heap instrument: powder settles in a tube that stands on a disc, the tube is lifted, and
/// when all is at rest, or at a set time, the heap on the disc is measured.
class Heap : public Process
{
public:
  Heap(const HeapParameters &parameters, const PhysicalProperties &physics)
      : p(parameters), wall_material(physics.wall_material()), apparatus(parameters, physics)
  {
  }

  void add_solids(std::vector<Solid> &solids) override
  {
    apparatus.add_solids(solids, wall_material);
  }
  void start(Simulation &simulation) override;
  void save(CheckpointWriter &writer) const override;
  void resume(Simulation &simulation, const Checkpoint &checkpoint) override;
  void step(Simulation &simulation) override;
  double progress(const Simulation &simulation) const override;
  std::string stage() const override;
  bool finished() const override { return phase == Phase::done; }
  /// Whether the run of a checkpoint has measured its heap.
  static bool is_done(const nlohmann::ordered_json &head)
  {
    return count_in<unsigned int>(head.at("heap").at("phase")) ==
           static_cast<unsigned int>(Phase::done);
  }
  void add_to_summary(nlohmann::ordered_json &summary) const override
  {
    summary.update(results.keys);
  }
  std::vector<Measurement> measurements() const override { return results.measured; }

private:
  enum class Phase
  {
    filling,
    lifting,
    resting,
    done
  };

  /// Of its lower end (m).
  double height_of_tube(const Simulation &simulation) const
  {
    return p.gap + apparatus.tube->at(simulation.time()).centre.y;
  }
  /// Writes apparatus.json.
  void describe(Simulation &simulation) const;
  void fill(Simulation &simulation);
  bool is_at_rest(Simulation &simulation);
  /// After the lifting: at rest, or by the clock.
  bool is_to_be_measured(Simulation &simulation);
  void begin_lifting(Simulation &simulation);
  void finish(Simulation &simulation);

  const HeapParameters p;
  const int wall_material;
  Apparatus apparatus;

  Phase phase = Phase::filling;
  double phase_start = 0.;                ///< (s)
  double calm_since = -1.;                ///< (s); negative: the powder moves
  double lift_start = -1., lift_way = 0.; ///< (s), (m); negative: not lifted yet
  Findings results;
};

} // namespace eunoe::heap

#endif
