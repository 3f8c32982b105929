// The passes of the spreader, one layer after the other.

#include <eunoe/processes/powder_spreading/powder_spreading.h>

namespace eunoe::spreading {

void PowderSpreading::schedule_passes(const double beginning)
{
  passes = make_schedule(p, apparatus, beginning, series.first_layer);
  double height = -reservoir_depth();
  for (std::size_t k = 0; k < passes.size(); ++k) {
    const Pass &pass = passes[k];
    const double stroke = p.actual_stroke(series.first_layer + static_cast<unsigned int>(k));
    if (k > 0 && p.feedstock == "replenished") {
      apparatus.platform->add(pass.feed, 0., {0., -apparatus.bed_depth - height, 0.});
      height = -apparatus.bed_depth;
    }
    apparatus.platform->add(pass.feed, stroke / p.platform_velocity, {0., stroke, 0.});
    height += stroke;
    apparatus.spreaders[k % Apparatus::n_spreaders]->add(pass.start);
    apparatus.plate->add(pass.weighing, p.plate_stroke() / p.plate_velocity,
                         {0., -p.plate_stroke(), 0.});
    if (apparatus.yielding_plate)
      apparatus.yielding_plate->add(pass.over_plate, pass.past_plate - pass.over_plate);
  }
  last_platform_height = height;
}

void PowderSpreading::step_passes(Simulation &simulation)
{
  const double t = simulation.time();
  if (wants_solid_loads(simulation.step_number()))
    layers->sample_force(simulation, handles.spreaders[pass_over_plate % Apparatus::n_spreaders]);
  if (next_feed < passes.size() && t >= passes[next_feed].feed) {
    if (p.feedstock == "replenished")
      fill_reservoir(simulation, -apparatus.bed_depth);
    ++next_feed;
  }
  pass_over_plate = -1;
  for (std::size_t k = next_weighing; k < passes.size() && t >= passes[k].over_plate; ++k)
    if (t < passes[k].past_plate)
      pass_over_plate = static_cast<int>(k);
  if (t >= passes[next_weighing].weighing) {
    const double plate_height = apparatus.plate->at(t).centre.y;
    layers->weigh(simulation, series.first_layer + static_cast<unsigned int>(next_weighing),
                  plate_height);
    if (++next_weighing == passes.size()) {
      layers->take_profile(simulation, plate_height);
      phase = Phase::done;
    }
  }
}

} // namespace eunoe::spreading
