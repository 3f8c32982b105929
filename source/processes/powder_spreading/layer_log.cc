#include <eunoe/checkpoint/head_values.h>
#include <eunoe/processes/box_mesh.h>
#include <eunoe/processes/powder_spreading/layer_log.h>
#include <eunoe/processes/powder_spreading/plate_measurement.h>

#include <cmath>
#include <limits>

namespace eunoe::spreading {

namespace {

/// The column that is no measurement.
const std::string wall_clock = "wall_seconds";

} // namespace

LayerLog::Fields LayerLog::add_fields(ParticleFields &fields)
{
  Fields handles;
  handles.layer = fields.add({"layer", 1, -1.});
  handles.tracked = fields.add({"tracked", 1, 0.});
  handles.displacement = fields.add({"displacement", 3, 0.});
  handles.on_plate = fields.add({"on_plate", 1, 0.});
  handles.last_position = fields.add({"last_position", 3, 0.});
  return handles;
}

LayerLog::LayerLog(Simulation &simulation, const SpreadingParameters &parameters,
                   const Apparatus &apparatus, const Fields &fields)
    : parameters(parameters), apparatus(apparatus), fields(fields),
      full_layer(apparatus.plate_area() * parameters.layer_thickness),
      file(simulation.output_folder().table(
          "layers.csv",
          {"layer", "time", "mass", "particles", "LRD", "CRD", "mass_removed", "mass_to_gap",
           "mass_to_collector", "spreader_force_mean", "spreader_force_max", "wall_seconds"})),
      pictures(simulation.output_folder().pictures(simulation.get_parameters().control.output_name +
                                                   "_layers")),
      solid_pictures(simulation.output_folder().pictures(
          simulation.get_parameters().control.output_name + "_layers_solids")),
      draws(parameters.layer_pictures), last_wall_time(MPI_Wtime())
{
}

LayerLog::OutletTotals LayerLog::outlet_totals(const Simulation &simulation) const
{
  OutletTotals totals;
  const auto &outlets = simulation.get_domain().outlets();
  for (std::size_t o = 0; o < outlets.size(); ++o) {
    ExactSum mass = simulation.get_ledger().through_outlet[o].mass;
    mass.reduce(simulation.communicator());
    if (outlets[o].boundary_id == box_side::lower_y)
      totals.gap += mass;
    else if (outlets[o].boundary_id == box_side::upper_x)
      totals.collector += mass;
  }
  return totals;
}

void LayerLog::sample_force(const Simulation &simulation, const SolidHandle spreader)
{
  const SolidLoad load = simulation.global_solid_loads()[spreader.number];
  const double force =
      norm(Vec3{load.force[0].value(), load.force[1].value(), load.force[2].value()});
  force_sum += force;
  force_max = std::max(force_max, force);
  ++n_forces;
}

LayerLog::OnPlate LayerLog::look_at_particles(Simulation &simulation, const unsigned int layer,
                                              const double plate_height) const
{
  ParticleArrays &p = simulation.changeable_particles();
  std::vector<double> &tags = p.component(fields.layer), &tracked = p.component(fields.tracked),
                      &on_plate = p.component(fields.on_plate);
  const PeriodicBox &box = simulation.get_domain().periods();
  const Vec3 plate_moved = {0., plate_height - last_plate_height, 0.};
  Tally present, kept;
  ExactSum volume;
  for (std::size_t row = 0; row < p.n_owned; ++row) {
    const Vec3 x = p.position[row].vec();
    const double mass = p.mass(row);
    const bool is_on = apparatus.is_over_plate(x, plate_height);
    const bool was_on = on_plate[row] != 0.;
    if (is_on) {
      present.count(mass);
      volume += sphere_mass(p.radius(row), 1.);
    }
    if (is_on && was_on)
      kept.count(mass);
    if (is_on && tags[row] < 0.)
      tags[row] = layer;
    Vec3 moved;
    if (is_on && was_on)
      moved = box.shortest(x - p.vector(fields.last_position, row) - plate_moved);
    tracked[row] = is_on && was_on ? 1. : 0.;
    on_plate[row] = is_on ? 1. : 0.;
    p.set_vector(fields.displacement, row, moved);
    p.set_vector(fields.last_position, row, x);
  }
  volume.reduce(simulation.communicator());
  return {present.global(simulation.communicator()), kept.global(simulation.communicator()),
          volume};
}

void LayerLog::weigh(Simulation &simulation, const unsigned int layer, const double plate_height)
{
  const OnPlate on_plate = look_at_particles(simulation, layer, plate_height);
  const Tally &present = on_plate.present;
  // Part of the removed powder has left the domain, so its mass is a difference and not counted.
  ExactSum removed = last_present;
  removed -= on_plate.kept.mass;

  // By volume: the layers may be of powders of different densities.
  const double volume = on_plate.volume.value();
  if (layer == 1)
    first_volume = volume;
  const RelativeDensities densities(layer, full_layer, volume, last_volume, first_volume);
  const OutletTotals out = outlet_totals(simulation);
  ExactSum to_gap = out.gap, to_collector = out.collector;
  to_gap -= last_out.gap;
  to_collector -= last_out.collector;
  const double now = MPI_Wtime();
  constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
  record(layer, simulation.time(),
         {{"mass", present.mass.value()},
          {"particles", static_cast<double>(present.number)},
          {"LRD", densities.layer},
          {"CRD", densities.cumulative},
          {"mass_removed", removed.value()},
          {"mass_to_gap", to_gap.value()},
          {"mass_to_collector", to_collector.value()},
          {"spreader_force_mean", n_forces > 0 ? force_sum / n_forces : nothing},
          {"spreader_force_max", n_forces > 0 ? force_max : nothing},
          {wall_clock, now - last_wall_time}});
  last_present = present.mass;
  last_volume = volume;
  last_plate_height = plate_height;
  last_out = out;
  last_wall_time = now;
  force_sum = force_max = 0.;
  n_forces = 0;
  if (draws) {
    simulation.write_pictures(*pictures);
    solid_pictures->write(simulation.time(), simulation.get_solids());
  }
}

void LayerLog::record(const unsigned int layer, const double time,
                      const std::vector<std::pair<std::string, double>> &row)
{
  std::vector<double> columns = {static_cast<double>(layer), time};
  for (const auto &[name, value] : row) {
    columns.push_back(value);
    // Before layer 0 there is no powder that could be removed.
    const bool is_defined = std::isfinite(value) && (layer > 0 || name != "mass_removed");
    if (is_defined && name != wall_clock)
      measured.push_back({name, static_cast<int>(layer), value});
  }
  file->write(columns);
}

void LayerLog::take_profile(Simulation &simulation, const double plate_height)
{
  PlateMeasurement plate(parameters, apparatus, simulation.get_parameters().physics,
                         simulation.get_domain().periods().is_periodic(2), plate_height);
  const ParticleArrays &p = simulation.complete_step();
  for (std::size_t row = 0; row < p.n_owned; ++row)
    plate.add(p.position[row].vec(), p.radius(row), p.mass(row));
  plate.reduce(simulation.communicator());
  // After more layers, those of the layers before are there.
  std::vector<Measurement> profile;
  plate.append_to(profile);
  const auto is_replaced = [&profile](const Measurement &old) {
    return std::any_of(profile.begin(), profile.end(),
                       [&old](const Measurement &m) { return m.observable == old.observable; });
  };
  measured.erase(std::remove_if(measured.begin(), measured.end(), is_replaced), measured.end());
  measured.insert(measured.end(), profile.begin(), profile.end());
}

std::vector<ObservableDescription> LayerLog::observables()
{
  const std::string layer = "layer", bin = "bin along the plate, from its start";
  return {
      {"mass", "kg", layer, "mass of the powder on the plate"},
      {"particles", "1", layer, "number of particles on the plate"},
      {"LRD", "1", layer, "layer relative density, from layer 1 on"},
      {"CRD", "1", layer, "cumulative relative density, from layer 2 on"},
      {"mass_removed", "kg", layer,
       "mass taken from the layers below during the pass, from layer 1 on"},
      {"mass_to_gap", "kg", layer, "mass lost through the gaps since the last weighing"},
      {"mass_to_collector", "kg", layer, "mass lost over the end since the last weighing"},
      {"spreader_force_mean", "N", layer, "mean force on the spreader over the plate"},
      {"spreader_force_max", "N", layer, "largest force on the spreader over the plate"},
      {"surface_height", "m", bin,
       "mean height of the surface after the last layer, over the level of the transfer plate"},
      {"surface_roughness", "m", "",
       "standard deviation of the surface's height after the last layer"},
      {"mean_diameter", "m", bin, "mean diameter by mass of all powder on the plate at the end"},
      {"solid_fraction", "1", "layer of the nominal thickness, from the plate up",
       "share of solid material over the plate at the end"}};
}

nlohmann::ordered_json LayerLog::save() const
{
  return {{"last_present", last_present.words()},
          {"last_volume", last_volume},
          {"first_volume", first_volume},
          {"last_plate_height", last_plate_height},
          {"last_to_gap", last_out.gap.words()},
          {"last_to_collector", last_out.collector.words()},
          {"force_sum", force_sum},
          {"force_max", force_max},
          {"n_forces", n_forces},
          {"measured", to_json(measured)}};
}

void LayerLog::load(const nlohmann::ordered_json &saved)
{
  last_present = exact_sum_in(saved.at("last_present"));
  last_volume = number_in(saved.at("last_volume"));
  first_volume = number_in(saved.at("first_volume"));
  last_plate_height = number_in(saved.at("last_plate_height"));
  last_out.gap = exact_sum_in(saved.at("last_to_gap"));
  last_out.collector = exact_sum_in(saved.at("last_to_collector"));
  force_sum = number_in(saved.at("force_sum"));
  force_max = number_in(saved.at("force_max"));
  n_forces = count_in<unsigned int>(saved.at("n_forces"));
  measured = measurements_in(saved.at("measured"));
}

} // namespace eunoe::spreading
