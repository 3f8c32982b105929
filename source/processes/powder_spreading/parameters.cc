#include <eunoe/core/declare.h>
#include <eunoe/processes/powder_spreading/parameters.h>

namespace eunoe::spreading {

namespace {

void declare_apparatus(dealii::ParameterHandler &prm, SpreadingParameters &p)
{
  using declare::not_negative;
  not_negative(prm, "feedstock platform length W1", p.w1,
               "Length of the rising platform in x (m).");
  not_negative(prm, "transfer plate length W2", p.w2,
               "Length of the plate between platform and gap (m).");
  not_negative(prm, "measuring plate length W3", p.w3, "Length of the falling plate (m).");
  not_negative(prm, "exit plate length W4", p.w4,
               "Length of the plate between the measuring plate's gap and the collector (m).");
  not_negative(prm, "length factor", p.length_factor,
               "Factor on the four lengths: n/7 for the paper's L_n; the gap and the spreader keep "
               "their sizes.");
  not_negative(prm, "depth", p.depth, "Depth of the simulated slice in z, which is periodic (m).");
  not_negative(prm, "gap", p.gap, "Width of the gap on both sides of the measuring plate (m).");
  not_negative(
      prm, "lip height", p.lip,
      "Height of the edges of the plates at the gap, below which powder falls freely (m). Beside "
      "rims the edges are as deep as these.");
  not_negative(prm, "rim width", p.rim,
               "Width of the wall between the measuring plate and each gap, as deep as the plate "
               "goes, which holds the bed at its ends (m); 0: none, the gap borders the plate.");
}

void declare_spreader(dealii::ParameterHandler &prm, SpreadingParameters &p)
{
  using declare::not_negative;
  declare::choice(prm, "spreader", p.spreader, "half round|flat blade", "Shape of the spreader.");
  not_negative(prm, "spreader radius R_s", p.spreader_radius, "half round: radius (m).");
  not_negative(prm, "spreader thickness", p.spreader_thickness, "flat blade: thickness in x (m).");
  not_negative(
      prm, "spreader height", p.spreader_height,
      "Height of the spreader over its lowest line (m); 0: as high as the powder before it "
      "can pile up.");
  declare::between(prm, "spreader facets", p.spreader_facets, 4, 1000,
                   "half round: number of facets of the half circle.");
  declare::entry(prm, "spreader clearance delta_s", p.clearance,
                 "Height of the spreader's lowest line over the transfer plate (m).");
}

void declare_passes(dealii::ParameterHandler &prm, SpreadingParameters &p)
{
  using declare::not_negative;
  declare::between(prm, "number of layers", p.n_layers, 0, 10000,
                   "Number of passes; the layers are numbered from 0.");
  not_negative(prm, "layer thickness delta_l", p.layer_thickness,
               "Stroke of the measuring plate after every pass (m).");
  not_negative(prm, "first layer thickness", p.first_thickness,
               "Depth of the measuring plate below the transfer plate in the first pass (m).");
  not_negative(prm, "spreading velocity v_s", p.velocity, "Velocity of the spreader (m/s).");
  not_negative(prm, "feedstock stroke delta_f", p.stroke,
               "Stroke of the feedstock platform before every pass (m).");
  not_negative(prm, "first feedstock stroke", p.first_stroke,
               "Stroke of the feedstock platform before the first pass (m).");
  not_negative(
      prm, "measuring plate velocity", p.plate_velocity,
      "Mean velocity of the measuring plate's strokes, which start and end smoothly (m/s).");
  not_negative(prm, "feedstock platform velocity", p.platform_velocity,
               "Mean velocity of the feedstock platform's strokes (m/s).");
  declare::between(prm, "pass overlap", p.overlap, 0.05, 1.,
                   "Share of a pass after which the next may start, as far as the plates' strokes "
                   "allow it; 1: one after the other.");
  not_negative(
      prm, "rest before weighing", p.rest_before_weighing,
      "Time between the passing of the spreader's rear over the end of the measuring plate "
      "and the weighing (s).");
}

void declare_feedstock(dealii::ParameterHandler &prm, SpreadingParameters &p)
{
  using declare::not_negative;
  declare::choice(prm, "feedstock", p.feedstock, "replenished|full",
                  "replenished: a shallow bed is settled once and copied back before every pass, "
                  "shifted and mirrored in z at random, after the old powder has been taken out. "
                  "full: one deep reservoir for all passes.");
  declare::count(prm, "feedstock particle type", p.particle_type,
                 "Type of the particles of the feedstock. Others may lie on the plate from an "
                 "earlier series of layers.");
  not_negative(
      prm, "feedstock bed depth", p.bed_depth,
      "Depth below the transfer plate of the bed that is settled (m); 0: the stroke and the "
      "margin.");
  not_negative(prm, "feedstock margin", p.bed_margin,
               "Powder left below the level of the transfer plate after the stroke (m).");
  not_negative(prm, "feedstock level", p.bed_level,
               "Height of the bed's surface over the transfer plate before a stroke (m): a pass "
               "leaves it at the spreader's clearance. What stands above it is taken away.");
  not_negative(prm, "feedstock insertion speed", p.insertion_speed,
               "Downward velocity of the particles inserted for the bed (m/s).");
  not_negative(prm, "settled speed", p.settled_speed,
               "The bed is at rest when 99 % of the particles are slower than this (m/s).");
  not_negative(prm, "settling time", p.settling_time,
               "Longest time that the bed is given to come to rest (s).");
  declare::count(prm, "seed", p.seed, "Seed of the random positions, shifts and mirrorings.");
}

void declare_imperfections(dealii::ParameterHandler &prm, SpreadingParameters &p)
{
  using declare::not_negative;
  declare::entry(prm, "spreader clearance offset", p.clearance_offset,
                 "Error of the clearance: the spreader is higher by this (m).");
  not_negative(
      prm, "spreader tilt", p.spreader_tilt,
      "Difference between the largest and the smallest clearance over the depth (m), about "
      "the same mean. Between side walls the spreader rises along z; in a periodic slice it "
      "falls over one half of the depth and rises over the other.");
  not_negative(prm, "spreader vibration amplitude", p.vibration_amplitude,
               "Amplitude of a vertical vibration of the spreader (m).");
  not_negative(prm, "spreader vibration frequency", p.vibration_frequency,
               "Frequency of that vibration (Hz).");
  declare::entry(prm, "layer thickness error", p.plate_stroke_error,
                 "Relative error of the measuring plate's stroke: it falls by delta_l (1 + "
                 "error), while the relative densities are computed with delta_l.");
  declare::entry(prm, "feedstock stroke error", p.stroke_error,
                 "Relative error of the feedstock platform's strokes.");
  not_negative(prm, "plate recoil", p.plate_recoil,
               "Distance by which the measuring plate yields while the spreader passes over it "
               "(m): a squared sine of the time between the spreader's arrival and its "
               "leaving.");
  declare::entry(prm, "side walls", p.side_walls,
                 "Whether the slice ends at two walls in z, instead of being periodic.");
  declare::at_least(prm, "side wall friction", p.side_wall_friction, -1.,
                    "Sliding friction coefficient of the side walls; -1: that of all walls.");
}

void declare_measurement(dealii::ParameterHandler &prm, SpreadingParameters &p)
{
  declare::between(prm, "profile bins", p.profile_bins, 1, 10000,
                   "Number of bins along the plate in which the surface's height and the mean "
                   "diameter are measured after the last layer.");
  declare::entry(prm, "layer pictures", p.layer_pictures,
                 "Whether the particles are written at every weighing (<name>_layers.pvd).");
  declare::count(prm, "spreader force sampling", p.force_sampling,
                 "Steps between two readings of the force on the spreader.", 1);
}

} // namespace

void SpreadingParameters::declare(dealii::ParameterHandler &prm)
{
  declare::enter(prm, section);
  declare_apparatus(prm, *this);
  declare_spreader(prm, *this);
  declare_passes(prm, *this);
  declare_feedstock(prm, *this);
  declare_imperfections(prm, *this);
  declare_measurement(prm, *this);
  declare::leave(prm);
}

void SpreadingParameters::check(const ParameterCheck &check) const
{
  const auto positive = [&](double value, const std::string &entry) {
    check.require(value > 0., {section}, entry, "is " + format(value) + ".",
                  "Give a positive value.");
  };
  positive(w1, "feedstock platform length W1");
  positive(w2, "transfer plate length W2");
  positive(w3, "measuring plate length W3");
  positive(w4, "exit plate length W4");
  positive(length_factor, "length factor");
  positive(depth, "depth");
  positive(gap, "gap");
  positive(layer_thickness, "layer thickness delta_l");
  positive(velocity, "spreading velocity v_s");
  positive(stroke, "feedstock stroke delta_f");
  positive(first_stroke, "first feedstock stroke");
  positive(plate_velocity, "measuring plate velocity");
  positive(platform_velocity, "feedstock platform velocity");
  positive(settled_speed, "settled speed");
  positive(settling_time, "settling time");
  positive(spreader == "half round" ? spreader_radius : spreader_thickness,
           spreader == "half round" ? "spreader radius R_s" : "spreader thickness");
  check.require(n_layers > 0, {section}, "number of layers", "is 0.",
                "Give at least 1 layer, 21 for the paper's case.");
  check.require(clearance > 0., {section}, "spreader clearance delta_s",
                "is " + format(clearance) +
                    " m: the spreader would stand inside the transfer "
                    "plate.",
                "Give a positive clearance, 100e-6 in the paper.");
  check.require(
      spreader_height == 0. || spreader != "half round" || spreader_height >= spreader_radius,
      {section}, "spreader height", "is " + format(spreader_height) + " m, less than the radius.",
      "Give at least the radius, or 0 for a height made to measure.");
  check_imperfections(check);
}

void SpreadingParameters::check_imperfections(const ParameterCheck &check) const
{
  const double lowest = clearance - 0.5 * spreader_tilt;
  check.require(lowest > 0. || clearance <= 0., {section}, "spreader tilt",
                "is " + format(spreader_tilt) +
                    " m, so that one side of the spreader would stand inside the transfer plate.",
                "Give less than twice the clearance.");
  check.require(
      lowest <= 0. || lowest + clearance_offset > 0., {section}, "spreader clearance offset",
      "is " + format(clearance_offset) + " m, which takes away all of the smallest clearance of " +
          format(lowest) + " m: the spreader would stand inside the transfer plate.",
      "Give a larger offset.");
  check.require(
      vibration_amplitude == 0. || lowest + clearance_offset <= 0. ||
          vibration_amplitude < lowest + clearance_offset,
      {section}, "spreader vibration amplitude",
      "is " + format(vibration_amplitude) + " m, not less than the smallest clearance of " +
          format(lowest + clearance_offset) + " m: the spreader would hit the transfer plate.",
      "Give a smaller amplitude.");
  check.require(vibration_amplitude == 0. || vibration_frequency > 0., {section},
                "spreader vibration frequency", "is 0 while there is an amplitude.",
                "Give a positive frequency, for example 100.");
  check.require(plate_stroke_error > -1., {section}, "layer thickness error",
                "is " + format(plate_stroke_error) + ", so that the plate would not fall.",
                "Give more than -1.");
  check.require(stroke_error > -1., {section}, "feedstock stroke error",
                "is " + format(stroke_error) + ", so that no powder would come.",
                "Give more than -1.");
  check.require(side_wall_friction == -1. || side_wall_friction >= 0., {section},
                "side wall friction", "is " + format(side_wall_friction) + ".",
                "Give at least 0, or -1 for the friction of all walls.");
  check.advise(side_wall_friction == -1. || side_walls, {section}, "side wall friction",
               "is set, but there are no side walls.", "Set 'side walls = true'.");
  check.require(plate_recoil < layer_thickness, {section}, "plate recoil",
                "is " + format(plate_recoil) + " m, not less than a layer of " +
                    format(layer_thickness) + " m.",
                "Give less; real plates yield by some micrometres.");
}

} // namespace eunoe::spreading
