#include <eunoe/checkpoint/checkpoint_file.h>
#include <eunoe/checkpoint/head_values.h>
#include <eunoe/processes/powder_spreading/powder_spreading.h>

#include <algorithm>

namespace eunoe::spreading {

void PowderSpreading::start(Simulation &simulation)
{
  layers = std::make_unique<LayerLog>(simulation, p, apparatus, layer_fields);
  simulation.output_folder().write("apparatus.json",
                                   apparatus.as_json(feedstock(simulation).density));
  insert_loose_bed(simulation);
}

void PowderSpreading::step(Simulation &simulation)
{
  if (n_fillings == 0 && phase == Phase::settling_bed)
    empty_reservoir(simulation);
  else if (phase == Phase::passes)
    step_passes(simulation);
  else if (phase != Phase::done && has_settled(simulation))
    go_on_after_settling(simulation);
}

void PowderSpreading::save(CheckpointWriter &writer) const
{
  writer.head["powder spreading"] = {{"phase", static_cast<int>(phase)},
                                     {"phase_start", phase_start},
                                     {"fillings", n_fillings},
                                     {"lowering", lowering},
                                     {"beginning", passes.empty() ? -1. : passes.front().feed},
                                     {"next_feed", next_feed},
                                     {"next_weighing", next_weighing},
                                     {"pass_over_plate", pass_over_plate},
                                     {"series", save_series()},
                                     {"is done", phase == Phase::done},
                                     {"layers weighed", series.first_layer + next_weighing},
                                     {"last platform height", last_platform_height},
                                     {"layers", layers->save()}};
  bed.save(writer);
}

void PowderSpreading::resume(Simulation &simulation, const Checkpoint &checkpoint)
{
  const auto &saved = checkpoint.head.at("powder spreading");
  // May refuse to go on in a table that was changed, and is first for that.
  layers = std::make_unique<LayerLog>(simulation, p, apparatus, layer_fields);
  simulation.output_folder().write("apparatus.json",
                                   apparatus.as_json(feedstock(simulation).density));
  layers->load(saved.at("layers"));
  const auto weighed = count_in<unsigned int>(saved.at("layers weighed"));
  if (saved.at("is done").get<bool>() && p.n_layers > weighed) {
    checkpoint.require(weighed > 0, "its layers are not those of the case.");
    begin_series(simulation.time(), weighed, number_in(saved.at("last platform height")));
    return;
  }
  load_series(saved.at("series"));
  checkpoint.require(series.first_layer < p.n_layers, "its layers are not those of the case.");
  if (series.first_layer > 0)
    set_out_series();
  const auto phase_number = count_in<unsigned int>(saved.at("phase"));
  phase_start = number_in(saved.at("phase_start"));
  n_fillings = count_in<unsigned int>(saved.at("fillings"));
  const double down = number_in(saved.at("lowering")), begin = number_in(saved.at("beginning"));
  if (down >= 0.)
    lower_platform(down);
  if (begin >= 0.)
    schedule_passes(begin);
  next_feed = count_in(saved.at("next_feed"));
  next_weighing = count_in(saved.at("next_weighing"));
  const double over_plate = number_in(saved.at("pass_over_plate"));
  if (phase_number > static_cast<unsigned int>(Phase::done) || next_feed > passes.size() ||
      next_weighing > passes.size() ||
      (phase_number == static_cast<unsigned int>(Phase::passes) &&
       next_weighing == passes.size()) ||
      over_plate < -1. || over_plate > static_cast<double>(passes.size()))
    throw checkpoint.damaged("its passes are not those of the case.");
  phase = static_cast<Phase>(phase_number);
  pass_over_plate = static_cast<int>(over_plate);
  bed.load(simulation, checkpoint);
}

double PowderSpreading::progress(const Simulation &simulation) const
{
  const double begin =
      passes.empty() ? simulation.time() + 0.25 * p.settling_time : passes.front().feed;
  const double end = begin + make_schedule(p, apparatus, 0., series.first_layer).back().weighing;
  return std::min(1., (simulation.time() - series.start) / (end - series.start));
}

std::string PowderSpreading::stage() const
{
  switch (phase) {
  case Phase::settling_bed:
    return "settling the feedstock";
  case Phase::settling_stack:
    return "filling the reservoir";
  case Phase::passes:
    return "layer " + std::to_string(series.first_layer + next_weighing) + " of " +
           std::to_string(p.n_layers - 1);
  default:
    return "";
  }
}

} // namespace eunoe::spreading
