#include <eunoe/checkpoint/checkpoint_file.h>
#include <eunoe/checkpoint/head_values.h>
#include <eunoe/processes/heap/heap.h>

#include <algorithm>

namespace eunoe::heap {

void Heap::describe(Simulation &simulation) const
{
  simulation.output_folder().write(
      "apparatus.json", apparatus.as_json(simulation.get_parameters().physics.types[0].density));
}

void Heap::start(Simulation &simulation)
{
  describe(simulation);
  fill(simulation);
}

void Heap::step(Simulation &simulation)
{
  if (phase == Phase::filling && is_at_rest(simulation))
    begin_lifting(simulation);
  else if (phase == Phase::lifting && simulation.time() >= apparatus.tube->end()) {
    phase = Phase::resting;
    phase_start = simulation.time();
    calm_since = -1.;
  } else if (phase == Phase::resting && is_to_be_measured(simulation))
    finish(simulation);
}

void Heap::save(CheckpointWriter &writer) const
{
  writer.head["heap"] = {{"phase", static_cast<int>(phase)},
                         {"phase_start", phase_start},
                         {"calm_since", calm_since},
                         {"lift_start", lift_start},
                         {"lift_way", lift_way},
                         {"results", results.keys},
                         {"measured", to_json(results.measured)}};
}

void Heap::resume(Simulation &simulation, const Checkpoint &checkpoint)
{
  describe(simulation);
  const auto &saved = checkpoint.head.at("heap");
  const auto phase_number = count_in<unsigned int>(saved.at("phase"));
  if (phase_number > static_cast<unsigned int>(Phase::done) || !saved.at("results").is_object())
    throw checkpoint.damaged("its heap is not that of the case.");
  phase = static_cast<Phase>(phase_number);
  phase_start = number_in(saved.at("phase_start"));
  calm_since = number_in(saved.at("calm_since"));
  lift_start = number_in(saved.at("lift_start"));
  lift_way = number_in(saved.at("lift_way"));
  results.keys = saved.at("results");
  results.measured = measurements_in(saved.at("measured"));
  if (lift_start >= 0.)
    apparatus.tube->begin(lift_start, lift_way);
}

double Heap::progress(const Simulation &simulation) const
{
  const auto durations = apparatus.expected_durations();
  double before = 0.;
  const auto present = std::min<std::size_t>(static_cast<std::size_t>(phase), 2);
  for (std::size_t k = 0; k < present; ++k)
    before += durations[k];
  const double now = std::min(simulation.time() - phase_start, 0.99 * durations[present]);
  return (before + now) / (durations[0] + durations[1] + durations[2]);
}

std::string Heap::stage() const
{
  switch (phase) {
  case Phase::filling:
    return "filling the tube";
  case Phase::lifting:
    return "lifting the tube";
  case Phase::resting:
    return "the heap comes to rest";
  default:
    return "";
  }
}

} // namespace eunoe::heap
