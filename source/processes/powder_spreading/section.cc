// What powder spreading asks of the other parameters, what it decides of them, what it will cost.

#include <eunoe/processes/box_mesh.h>
#include <eunoe/processes/common_checks.h>
#include <eunoe/processes/powder_spreading/powder_spreading.h>

#include <algorithm>

namespace eunoe::spreading {

namespace {

const ProcessRegistry::Registration registration(process_kinds(), "powder spreading", [] {
  return std::make_unique<SpreadingParameters>();
});

} // namespace

void SpreadingParameters::check_with(const Parameters &parameters,
                                     const ParameterCheck &check) const
{
  const std::size_t n_types = parameters.physics.types.size();
  check.require(particle_type < n_types, {section}, "feedstock particle type",
                "is " + std::to_string(particle_type) + ", and 'number of particle types' is " +
                    std::to_string(n_types) + ".",
                "Types are counted from 0.");
  check_gravity_of_process(parameters, check, "in powder spreading y points upwards");
  const double falling = insertion_speed + settling_wait * norm(parameters.physics.gravity);
  check.require(
      settled_speed < falling, {section}, "settled speed",
      "is " + format(settled_speed) + " m/s, and powder that is inserted falls at " +
          format(falling) +
          " m/s when it is looked at first, so that it would count as settled in the air.",
      "Give less, or a larger 'feedstock insertion speed'.");
  check_lengths(parameters, check);
  check_dosing(check);
  // Errors of the stroke do not change the powder.
  const double bed = bed_depth > 0. ? bed_depth : stroke + bed_margin;
  const double first_bed = std::max(bed, first_stroke + bed_margin);
  check.require(actual_stroke(0) <= first_bed && actual_stroke(1) <= bed, {section},
                "feedstock stroke error",
                "is " + format(stroke_error) +
                    ": the platform would rise above the level of the "
                    "transfer plate, as the bed is only " +
                    format(bed) + " m deep, and " + format(first_bed) + " m for the first layer.",
                "Give a smaller error or a larger 'feedstock margin'.");
  const double all_strokes = first_stroke + (std::max(1u, n_layers) - 1) * stroke;
  check.require(feedstock != "full" ||
                    (1. + stroke_error) * all_strokes <= std::max(bed, all_strokes + bed_margin),
                {section}, "feedstock stroke error",
                "is " + format(stroke_error) +
                    ": with 'feedstock = full' all strokes together would raise the platform above "
                    "the level of the transfer plate.",
                "Give a smaller error, a larger 'feedstock margin' or 'feedstock = replenished'.");
  refuse_decisions_of_process(check, "its last layer is weighed", "'number of layers' rules");
}

void SpreadingParameters::check_lengths(const Parameters &parameters,
                                        const ParameterCheck &check) const
{
  const double largest = parameters.physics.largest_diameter();
  for (const auto &[value, entry] :
       {std::pair(w1, "feedstock platform length W1"), std::pair(w3, "measuring plate length W3")})
    check.require(length_factor * value > 3. * largest, {section}, entry,
                  "times the length factor is " + format(length_factor * value) +
                      " m, less than three of the largest particles.",
                  "Give a larger length or factor.");
  check.require(depth >= 2. * largest, {section}, "depth",
                "is " + format(depth) + " m, less than two of the largest particles.",
                "Give a larger depth, 2e-3 in the paper.");
  const double reach =
      largest + parameters.detection.skin(largest) + parameters.contact_model(largest).range();
  check.require(side_walls || depth >= 2. * reach || depth < 2. * largest, {section}, "depth",
                "is " + format(depth) + " m, less than twice the " + format(reach) +
                    " m that particles can reach (largest diameter, skin and range of cohesion), "
                    "so that two particles could touch on both sides of the periodic slice.",
                "Give a larger depth, 2e-3 in the paper, or a smaller 'neighborhood threshold'.");
  check.require(bed_level <= clearance, {section}, "feedstock level",
                "is " + format(bed_level) + " m, above the spreader's clearance of " +
                    format(clearance) + " m, so that a stroke would feed more than its height.",
                "Give no more than 'spreader clearance delta_s'.");
  check.advise(bed_level <= mean_clearance() || bed_level > clearance, {section}, "feedstock level",
               "is " + format(bed_level) + " m, and errors of the clearance leave " +
                   format(mean_clearance()) +
                   " m below the spreader, so that a stroke feeds more than its height.",
               "Give less, unless that is what the error does.");
  // Each of its two contacts gives way by a hundredth of the diameter.
  constexpr double squeezed = 0.98;
  const double lowest = mean_clearance() - 0.5 * spreader_tilt - vibration_amplitude;
  check.advise(
      lowest <= 0. || lowest >= squeezed * largest, {section}, "spreader clearance delta_s",
      "leaves " + format(lowest) + " m below the spreader, less than the largest grain of " +
          format(largest) + " m, which cannot pass below it and is pushed along or jams.",
      "Give a larger clearance, or sieve out the grains with 'maximum diameter cutoff'.");
  constexpr double packing = 0.6;
  check.advise(
      layer_thickness >= packing * squeezed * largest, {section}, "layer thickness delta_l",
      "is " + format(layer_thickness) +
          " m: a layer of this solid, packed to 60 %, stands lower than the largest grain of " +
          format(largest) + " m, which finds no room.",
      "Give a thicker layer, or sieve out the grains with 'maximum diameter cutoff'.");
}

void SpreadingParameters::check_dosing(const ParameterCheck &check) const
{
  // Areas in x and y, of powder that packs alike on the platform and in the layer. A fresh bed
  // loses the part of its stroke that passes below the spreader.
  const double passes_below = std::max(clearance - bed_level, 0.);
  const double lost = feedstock == "full" ? 0. : passes_below;
  const auto advise = [&](double fed, double taken, const std::string &entry,
                          const std::string &what) {
    check.advise(fed >= taken, {section}, entry,
                 "feeds " + format(std::max(100. * fed / taken, 0.)) + " % of what " + what +
                     " takes, so that the end of the plate stays bare.",
                 "Give more: the paper's strokes feed nearly six times a layer.");
  };
  advise((first_stroke - passes_below) * w1, first_thickness * w3 + clearance * (w2 + w3),
         "first feedstock stroke", "the first layer and the clearance over the plates");
  if (n_layers > 1)
    advise((stroke - lost) * w1, layer_thickness * w3, "feedstock stroke delta_f", "a layer");
}

void SpreadingParameters::decide(Parameters &parameters) const
{
  const double largest = parameters.physics.largest_diameter();
  const Apparatus a(*this, largest);
  parameters.mesh =
      box_mesh(section, {0., a.y_bottom, 0.}, {a.x_end, a.y_top, a.depth}, largest,
               parameters.detection.skin(largest) + parameters.contact_model(largest).range());
  decide_boundaries(parameters);
  // The process decides when all is done; this is no more than an upper bound, far away as earlier
  // series may have been slower than this one.
  constexpr double far = 10.;
  parameters.control.end_control = "time";
  const double longest_pass = a.path() / velocity + plate_stroke() / plate_velocity +
                              std::max(actual_stroke(0), actual_stroke(1)) / platform_velocity;
  // Each layer may begin a series of its own, with a bed of its own.
  parameters.control.time_end = far * (make_schedule(*this, a, 0.).back().end +
                                       n_layers * (23. * settling_time + longest_pass));
}

void SpreadingParameters::decide_boundaries(Parameters &parameters) const
{
  BoundaryCondition collector, bottom;
  collector.type = bottom.type = "outlet";
  collector.id = box_side::upper_x;
  bottom.id = box_side::lower_y;
  parameters.boundaries.conditions = {collector, bottom};
  if (side_walls) {
    PhysicalProperties &physics = parameters.physics;
    physics.other_walls = {physics.wall};
    if (side_wall_friction >= 0.)
      physics.other_walls[0].friction = side_wall_friction;
    for (const unsigned int id : {box_side::lower_z, box_side::upper_z}) {
      BoundaryCondition wall;
      wall.id = id;
      wall.material = physics.wall_material(physics.wall_materials.size());
      parameters.boundaries.conditions.push_back(wall);
    }
  } else {
    BoundaryCondition period;
    period.type = "periodic";
    period.periodic_ids[0] = box_side::lower_z;
    period.periodic_ids[1] = box_side::upper_z;
    period.periodic_direction = 2;
    parameters.boundaries.conditions.push_back(period);
  }
}

RunEstimate SpreadingParameters::estimate(const Parameters &parameters) const
{
  const ParticleType &type = parameters.physics.types[particle_type];
  const Apparatus a(*this, parameters.physics.largest_diameter());
  const double volume = M_PI / 6. * type.sizes.make()->mean_cube();
  const double per_height = bed_fraction * a.plate_area() / volume;
  const double layer = per_height * layer_thickness, below = per_height * first_thickness;
  const double first = a.particles_in_bed(type, a.first_bed_depth + bed_level);
  const double later = feedstock == "full"
                           ? 0.5 * (first + a.particles_in_bed(type, bed_margin + bed_level))
                           : a.particles_in_bed(type, a.bed_depth + bed_level);
  const double transit = a.particles_in_bed(type, actual_stroke(1));
  const auto schedule = make_schedule(*this, a, 0.25 * settling_time);
  RunEstimate estimate;
  estimate.steps = schedule.back().weighing / parameters.control.time_step;
  estimate.pictures = layer_pictures ? n_layers : 0.;
  estimate.particles = later + transit + below + 0.5 * n_layers * layer;
  estimate.most_particles = std::max(first + transit, later + transit + below + n_layers * layer);
  return estimate;
}

std::unique_ptr<Process> SpreadingParameters::make(const Parameters &parameters) const
{
  return std::make_unique<PowderSpreading>(*this, parameters.physics);
}

double SpreadingParameters::fastest_solid() const
{
  // Of the plate that yields under the spreader.
  const double recoil_speed = M_PI * plate_recoil * velocity / (length_factor * w3);
  // A smooth stroke is at most twice as fast as on average.
  return std::max({std::hypot(velocity, vibration_speed()), 2. * plate_velocity + recoil_speed,
                   2. * platform_velocity});
}

std::vector<ObservableDescription> SpreadingParameters::observables() const
{
  return LayerLog::observables();
}

std::vector<std::string> SpreadingParameters::results() const
{
  return {"layers.csv", "apparatus.json"};
}

} // namespace eunoe::spreading
