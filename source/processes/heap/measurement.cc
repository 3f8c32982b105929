#include <eunoe/processes/heap/measurement.h>

#include <limits>

namespace eunoe::heap {

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

/// Columns of the outlines, in parts of the smallest diameter.
constexpr double column_width = 0.1;

struct MeanAndSpread
{
  double mean = 0., spread = 0.;
};

MeanAndSpread statistics(const std::vector<double> &values)
{
  MeanAndSpread result;
  for (const double value : values)
    result.mean += value / static_cast<double>(values.size());
  double squares = 0.;
  for (const double value : values)
    squares += (value - result.mean) * (value - result.mean);
  if (values.size() > 1)
    result.spread = std::sqrt(squares / static_cast<double>(values.size() - 1));
  return result;
}

/// Writes heap.csv: a row per view, then a row of means without a view's number.
void write_views(Simulation &simulation, const Silhouettes &views, nlohmann::ordered_json &found)
{
  const auto file = simulation.output_folder().table(
      "heap.csv", {"view", "direction", "projected_area", "base_angle", "height",
                   "base_angle_spread", "mass_on_disc", "mass_drained"});
  std::vector<double> areas, angles, heights;
  for (unsigned int view = 0; view < views.n_views(); ++view) {
    areas.push_back(views.area(view));
    angles.push_back(views.base_angle(areas.back()));
    heights.push_back(views.height(view));
    file->write({static_cast<double>(view), views.direction(view) * 180. / M_PI, areas.back(),
                 angles.back(), heights.back(), nothing, nothing, nothing});
  }
  const MeanAndSpread angle = statistics(angles);
  found["heap_base_angle"] = angle.mean;
  found["heap_base_angle_spread"] = angle.spread;
  found["heap_projected_area"] = statistics(areas).mean;
  found["heap_height"] = statistics(heights).mean;
  file->write({nothing, nothing, found["heap_projected_area"], angle.mean, found["heap_height"],
               angle.spread, found["heap_mass_on_disc"], found["heap_mass_drained"]});
}

/// Writes heap_profile.csv, and compares it with a measured profile if there is one.
void write_profile(Simulation &simulation, const Silhouettes &views, const std::string &measured,
                   nlohmann::ordered_json &found)
{
  const auto file =
      simulation.output_folder().table("heap_profile.csv", {"x", "mean", "spread", "measured"});
  const MeasuredProfile reference = measured.empty() ? MeasuredProfile() : read_profile(measured);
  double squares = 0., spreads = 0.;
  unsigned int n_compared = 0;
  const auto profile = views.profile();
  for (const Silhouettes::Bin &bin : profile) {
    const double expected = measured.empty() ? nothing : reference.at(bin.x);
    file->write({bin.x, bin.mean, bin.spread, expected});
    spreads += bin.spread / static_cast<double>(profile.size());
    if (std::isfinite(expected)) {
      squares += (bin.mean - expected) * (bin.mean - expected);
      ++n_compared;
    }
  }
  found["heap_profile_spread"] = spreads;
  if (n_compared > 0) {
    found["heap_measured_base_angle"] = views.base_angle(reference.area());
    found["heap_profile_difference"] = std::sqrt(squares / n_compared);
  }
}

/// Measurements that have a key of their own in summary.json.
std::vector<ObservableDescription> single_numbers()
{
  return {{"base_angle", "degrees", "", "mean base angle of the views"},
          {"base_angle_spread", "degrees", "", "standard deviation of the views' base angles"},
          {"height", "m", "", "mean over the views of the highest point"},
          {"mass_on_disc", "kg", "", "mass of the heap"},
          {"mass_drained", "kg", "", "mass that fell over the edge and left the domain"}};
}

} // namespace

Findings measure(Simulation &simulation, const HeapParameters &parameters,
                 const Apparatus &apparatus, const double tube_height)
{
  const auto sizes = simulation.get_parameters().physics.types[0].sizes.make();
  Silhouettes views(parameters.disc_diameter, 2. * sizes->largest(), parameters.n_views,
                    parameters.n_bins, column_width * sizes->smallest());
  const ParticleArrays &p = simulation.complete_step();
  Tally on_disc, clinging, drained;
  for (std::size_t row = 0; row < p.n_owned; ++row) {
    const Vec3 x = p.position[row].vec();
    const double radius = p.radius(row);
    const bool is_on =
        apparatus.is_on_disc(x, radius) && !apparatus.clings_to_tube(x.y, radius, tube_height);
    (is_on ? on_disc : clinging).count(p.mass(row));
    if (is_on)
      views.add(x, radius);
  }
  const MPI_Comm comm = simulation.communicator();
  views.reduce(comm);
  for (const Tally &outlet : simulation.get_ledger().through_outlet) {
    drained.number += outlet.number;
    drained.mass += outlet.mass;
  }
  on_disc = on_disc.global(comm);
  clinging = clinging.global(comm);

  Findings findings;
  nlohmann::ordered_json &found = findings.keys;
  found["heap_particles_on_disc"] = on_disc.number;
  found["heap_mass_on_disc"] = on_disc.mass.value();
  found["heap_mass_drained"] = drained.global(comm).mass.value();
  found["heap_mass_clinging"] = clinging.mass.value();
  write_views(simulation, views, found);
  write_profile(simulation, views, parameters.measured_profile, found);
  simulation.output_folder().write("heap_map.pgm", views.map());
  for (const ObservableDescription &single : single_numbers())
    findings.measured.push_back({single.name, 0, found.at("heap_" + single.name)});
  const std::vector<double> rings = views.rings(n_rings);
  for (unsigned int ring = 0; ring < n_rings; ++ring)
    findings.measured.push_back({"profile", static_cast<int>(ring), rings[ring]});
  return findings;
}

std::vector<ObservableDescription> observables()
{
  std::vector<ObservableDescription> all = single_numbers();
  all.push_back({"profile", "m", "ring, from the axis to the edge",
                 "mean height of the outline over all views and both sides"});
  return all;
}

} // namespace eunoe::heap
