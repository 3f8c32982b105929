#include <eunoe/checkpoint/checkpoint_file.h>
#include <eunoe/checkpoint/head_values.h>
#include <eunoe/processes/box_mesh.h>
#include <eunoe/processes/powder_spreading/powder_spreading.h>

#include <algorithm>

namespace eunoe::spreading {

namespace {

/// Solid fraction of a settled bed, for estimates.
constexpr double bed_fraction = 0.55;

const ProcessRegistry::Registration registration(process_kinds(), "powder spreading", [] {
  return std::make_unique<PowderSpreading>();
});

} // namespace

void PowderSpreading::check_with(const Parameters &parameters, const ParameterCheck &check) const
{
  const std::string section = "powder spreading";
  const double largest = parameters.physics.largest_diameter();
  check.require(parameters.physics.types.size() == 1, {"lagrangian physical properties"},
                "number of particle types",
                "is " + std::to_string(parameters.physics.types.size()) + ".",
                "Powder spreading works with one type; give the size classes as a custom "
                "distribution.");
  check.require(parameters.physics.gravity.y < 0. && parameters.physics.gravity.x == 0. &&
                    parameters.physics.gravity.z == 0.,
                {"lagrangian physical properties"}, "g", "does not point to -y.",
                "Set it to 0, -9.81, 0: in powder spreading y points upwards.");
  for (const auto &[value, entry] : {std::pair(p.w1, "feedstock platform length W1"),
                                     std::pair(p.w3, "measuring plate length W3")})
    check.require(p.length_factor * value > 3. * largest, {section}, entry,
                  "times the length factor is " + format(p.length_factor * value) +
                      " m, less than three of the largest particles.",
                  "Give a larger length or factor.");
  check.require(p.depth >= 2. * largest, {section}, "depth",
                "is " + format(p.depth) + " m, less than two of the largest particles.",
                "Give a larger depth, 2e-3 in the paper.");
  const double reach =
      largest + parameters.detection.skin(largest) + parameters.contact_model(largest).range();
  check.require(p.side_walls || p.depth >= 2. * reach || p.depth < 2. * largest, {section}, "depth",
                "is " + format(p.depth) + " m, less than twice the " + format(reach) +
                    " m that particles can reach (largest diameter, skin and range of cohesion), "
                    "so that two particles could touch on both sides of the periodic slice.",
                "Give a larger depth, 2e-3 in the paper, or a smaller 'neighborhood threshold'.");
  // Each of its two contacts gives way by a hundredth of the diameter.
  constexpr double squeezed = 0.98;
  const double lowest = p.mean_clearance() - 0.5 * p.spreader_tilt - p.vibration_amplitude;
  check.advise(
      lowest <= 0. || lowest >= squeezed * largest, {section}, "spreader clearance delta_s",
      "leaves " + format(lowest) + " m below the spreader, less than the largest grain of " +
          format(largest) + " m, which cannot pass below it and is pushed along or jams.",
      "Give a larger clearance, or sieve out the grains with 'maximum diameter cutoff'.");
  // The powder that is there does not depend on how it is dosed.
  const double bed = p.bed_depth > 0. ? p.bed_depth : p.stroke + p.bed_margin;
  const double first_bed = std::max(bed, p.first_stroke + p.bed_margin);
  check.require(p.actual_stroke(0) <= first_bed && p.actual_stroke(1) <= bed, {section},
                "feedstock stroke error",
                "is " + format(p.stroke_error) +
                    ": the platform would rise above the level of the "
                    "transfer plate, as the bed is only " +
                    format(bed) + " m deep, and " + format(first_bed) + " m for the first layer.",
                "Give a smaller error or a larger 'feedstock margin'.");
  for (const char *const other :
       {"mesh", "box refinement", "DEM boundary conditions", "insertion info"})
    check.require(!check.has_changes(other), {other}, "", "is set, but the process makes its own.",
                  "Remove the subsection.");
  for (const char *const end : {"end control", "time end", "iteration end"})
    check.require(!check.is_changed({"simulation control"}, end), {"simulation control"}, end,
                  "is set, but the process ends when its last layer is weighed.",
                  "Remove the entry; 'number of layers' rules the length of the run.");
}

void PowderSpreading::prepare(Parameters &parameters)
{
  const double largest = parameters.physics.largest_diameter();
  apparatus = std::make_unique<Apparatus>(p, largest);
  const Apparatus &a = *apparatus;

  parameters.mesh =
      box_mesh("powder spreading", {0., a.y_bottom, 0.}, {a.x_end, a.y_top, a.depth}, largest,
               parameters.detection.skin(largest) + parameters.contact_model(largest).range());

  set_boundaries(parameters);
  // The process decides when all is done; this is no more than an upper bound.
  parameters.control.end_control = "time";
  parameters.control.time_end =
      make_schedule(p, a, 22. * p.settling_time).back().end + p.settling_time;
}

void PowderSpreading::set_boundaries(Parameters &parameters) const
{
  BoundaryCondition collector, bottom;
  collector.type = bottom.type = "outlet";
  collector.id = 1;
  bottom.id = 2;
  parameters.boundaries.conditions = {collector, bottom};
  if (p.side_walls) {
    PhysicalProperties &physics = parameters.physics;
    physics.other_walls = {physics.wall};
    if (p.side_wall_friction >= 0.)
      physics.other_walls[0].friction = p.side_wall_friction;
    for (const unsigned int id : {4u, 5u}) {
      BoundaryCondition wall;
      wall.id = id;
      wall.material = physics.wall_material(physics.wall_materials.size());
      parameters.boundaries.conditions.push_back(wall);
    }
  } else {
    BoundaryCondition period;
    period.type = "periodic";
    period.periodic_ids[0] = 4;
    period.periodic_ids[1] = 5;
    period.periodic_direction = 2;
    parameters.boundaries.conditions.push_back(period);
  }
}

double PowderSpreading::bed_particles(const Parameters &parameters, const double bed_depth) const
{
  const double volume = M_PI / 6. * parameters.physics.types[0].sizes.make()->mean_cube();
  return bed_fraction * apparatus->x_transfer * apparatus->depth * bed_depth / volume;
}

RunEstimate PowderSpreading::estimate(const Parameters &parameters) const
{
  const Apparatus &a = *apparatus;
  const double volume = M_PI / 6. * parameters.physics.types[0].sizes.make()->mean_cube();
  const double layer = bed_fraction * a.plate_area() * p.layer_thickness / volume;
  const double first = bed_particles(parameters, a.first_bed_depth);
  const double later = p.feedstock == "full"
                           ? 0.5 * (first + bed_particles(parameters, p.bed_margin))
                           : bed_particles(parameters, a.bed_depth);
  const double transit = bed_particles(parameters, p.actual_stroke(1));
  const auto schedule = make_schedule(p, a, 0.25 * p.settling_time);
  RunEstimate estimate;
  estimate.steps = schedule.back().weighing / parameters.control.time_step;
  estimate.particles = later + transit + 0.5 * p.n_layers * layer;
  estimate.most_particles = std::max(first + transit, later + transit + p.n_layers * layer);
  return estimate;
}

void PowderSpreading::start(Simulation &simulation)
{
  layers = std::make_unique<LayerLog>(simulation, p, *apparatus);
  simulation.output_folder().write(
      "apparatus.json", apparatus->as_json(simulation.get_parameters().physics.types[0].density));
  insert_loose_bed(simulation);
}

void PowderSpreading::step(Simulation &simulation)
{
  if (phase == Phase::passes)
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
                                     {"layers", layers->save()}};
  bed.save(writer);
}

void PowderSpreading::resume(Simulation &simulation, const Checkpoint &checkpoint)
{
  const auto &saved = checkpoint.head.at("powder spreading");
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
  layers = std::make_unique<LayerLog>(simulation, p, *apparatus);
  layers->load(saved.at("layers"));
  bed.load(simulation, checkpoint);
}

double PowderSpreading::progress(const Simulation &simulation) const
{
  const double begin =
      passes.empty() ? simulation.time() + 0.25 * p.settling_time : passes.front().feed;
  const double end = begin + make_schedule(p, *apparatus, 0.).back().weighing;
  return std::min(1., simulation.time() / end);
}

std::string PowderSpreading::stage() const
{
  switch (phase) {
  case Phase::settling_bed:
    return "settling the feedstock";
  case Phase::settling_stack:
    return "filling the reservoir";
  case Phase::passes:
    return "layer " + std::to_string(next_weighing) + " of " + std::to_string(passes.size() - 1);
  default:
    return "";
  }
}

} // namespace eunoe::spreading
