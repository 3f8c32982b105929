#include <eunoe/processes/heap/measurement.h>
#include <eunoe/processes/heap/standing_height.h>
#include <eunoe/processes/solid_fraction.h>

#include <limits>

namespace eunoe::heap {

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

/// Columns of the outlines, in parts of the smallest diameter.
constexpr double column_width = 0.1;

/// Radius of the middle in which the solid fraction is measured, in parts of the disc's: the
/// surface of a cone over it is at half of its height and above.
constexpr double middle_share = 0.5;

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

/// What the shape of a heap tells.
class Shape
{
public:
  Shape(const HeapParameters &p, const Apparatus &apparatus, const SizeDistribution &sizes)
      : views(p.disc_diameter, 2. * sizes.largest(), p.n_views, p.n_bins,
              column_width * sizes.smallest()),
        density(Footprint::disc(middle_share * 0.5 * p.disc_diameter), 0.,
                apparatus.expected_heap() / p.n_density_layers, p.n_density_layers)
  {
  }

  void add(const Vec3 &centre, const double radius, const double mass)
  {
    on_disc.count(mass);
    views.add(centre, radius);
    density.add(centre, radius);
  }

  void reduce(MPI_Comm comm)
  {
    views.reduce(comm);
    density.reduce(comm);
    on_disc = on_disc.global(comm);
  }

  /// The keys of summary.json.
  nlohmann::ordered_json keys() const
  {
    std::vector<double> areas, angles, heights;
    for (unsigned int view = 0; view < views.n_views(); ++view) {
      areas.push_back(views.area(view));
      angles.push_back(views.base_angle(areas.back()));
      heights.push_back(views.height(view));
    }
    const MeanAndSpread angle = statistics(angles);
    return {{"heap_particles_on_disc", on_disc.number},
            {"heap_mass_on_disc", on_disc.mass.value()},
            {"heap_base_angle", angle.mean},
            {"heap_base_angle_spread", angle.spread},
            {"heap_projected_area", statistics(areas).mean},
            {"heap_height", statistics(heights).mean}};
  }

  /// Profile and solid fractions.
  void append_to(std::vector<Measurement> &measured, const unsigned int n_rings) const
  {
    const std::vector<double> rings = views.rings(n_rings);
    for (unsigned int ring = 0; ring < n_rings; ++ring)
      measured.push_back({"profile", static_cast<int>(ring), rings[ring]});
    for (unsigned int layer = 0; layer < density.n_layers(); ++layer)
      measured.push_back({"solid_fraction", static_cast<int>(layer), density(layer)});
  }

  Silhouettes views;

private:
  SolidFraction density;
  Tally on_disc;
};

/// Writes heap.csv: a row per view, then a row of means without a view's number.
void write_views(Simulation &simulation, const Silhouettes &views,
                 const nlohmann::ordered_json &found)
{
  const auto file = simulation.output_folder().table(
      "heap.csv", {"view", "direction", "projected_area", "base_angle", "height",
                   "base_angle_spread", "mass_on_disc", "mass_drained"});
  for (unsigned int view = 0; view < views.n_views(); ++view) {
    const double area = views.area(view);
    file->write({static_cast<double>(view), views.direction(view) * 180. / M_PI, area,
                 views.base_angle(area), views.height(view), nothing, nothing, nothing});
  }
  file->write({nothing, nothing, found["heap_projected_area"], found["heap_base_angle"],
               found["heap_height"], found["heap_base_angle_spread"], found["heap_mass_on_disc"],
               found["heap_mass_drained"]});
}

/// Writes heap_profile.csv, and compares it with a measured profile if there is one.
void write_profile(Simulation &simulation, const Silhouettes &views, const std::string &measured,
                   nlohmann::ordered_json &found)
{
  const auto file =
      simulation.output_folder().table("heap_profile.csv", {"x", "mean", "spread", "measured"});
  MeasuredProfile reference;
  try {
    if (!measured.empty())
      reference = read_profile(measured);
  } catch (const UserError &error) { // it was in order when the run began
    simulation.get_log().warning(error.what() + std::string(" The heap is not compared with it."));
  }
  double squares = 0., spreads = 0.;
  unsigned int n_compared = 0;
  const auto profile = views.profile();
  for (const Silhouettes::Bin &bin : profile) {
    const double expected = reference.x.empty() ? nothing : reference.at(bin.x);
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
  Shape shape(parameters, apparatus, *sizes);
  const ParticleArrays &p = simulation.complete_step();
  const MPI_Comm comm = simulation.communicator();
  const auto is_over_disc = [&](const std::size_t row) {
    const Vec3 x = p.position[row].vec();
    return apparatus.is_on_disc(x, p.radius(row)) &&
           !apparatus.clings_to_tube(x.y, p.radius(row), tube_height);
  };
  StandingHeight stands(apparatus.y_top, sizes->largest());
  for (std::size_t row = 0; row < p.n_owned; ++row)
    if (is_over_disc(row))
      stands.see(p.position[row].y);
  stands.reduce(comm);
  const double top = stands();
  Tally clinging, drained;
  for (std::size_t row = 0; row < p.n_owned; ++row)
    if (is_over_disc(row) && p.position[row].y < top)
      shape.add(p.position[row].vec(), p.radius(row), p.mass(row));
    else
      clinging.count(p.mass(row));
  shape.reduce(comm);
  for (const Tally &outlet : simulation.get_ledger().through_outlet) {
    drained.number += outlet.number;
    drained.mass += outlet.mass;
  }

  Findings findings;
  nlohmann::ordered_json &found = findings.keys;
  found = shape.keys();
  found["heap_mass_drained"] = drained.global(comm).mass.value();
  found["heap_mass_clinging"] = clinging.global(comm).mass.value();
  write_views(simulation, shape.views, found);
  write_profile(simulation, shape.views, parameters.measured_profile, found);
  simulation.output_folder().write("heap_map.pgm", shape.views.map());
  for (const ObservableDescription &single : single_numbers())
    findings.measured.push_back({single.name, 0, found.at("heap_" + single.name)});
  shape.append_to(findings.measured, parameters.n_rings);
  return findings;
}

std::vector<Measurement> measure(const HeapParameters &parameters,
                                 const PhysicalProperties &physics,
                                 const std::vector<GivenParticle> &particles)
{
  const Apparatus apparatus(parameters, physics);
  const auto sizes = physics.types[0].sizes.make();
  Shape shape(parameters, apparatus, *sizes);
  double largest = sizes->largest();
  for (const GivenParticle &particle : particles)
    largest = std::max(largest, 2. * particle.radius);
  StandingHeight stands(apparatus.y_top, largest);
  for (const GivenParticle &particle : particles)
    if (apparatus.is_on_disc(particle.centre, particle.radius))
      stands.see(particle.centre.y);
  const double top = stands();
  for (const GivenParticle &particle : particles)
    if (apparatus.is_on_disc(particle.centre, particle.radius) && particle.centre.y < top)
      shape.add(particle.centre, particle.radius, particle.mass);
  const nlohmann::ordered_json found = shape.keys();
  if (found.at("heap_particles_on_disc") == 0)
    throw UserError(
        "None of the " + std::to_string(particles.size()) +
        " particles lies on the disc, whose face is the plane y = 0 and whose radius is " +
        format(0.5 * parameters.disc_diameter) +
        " m around the origin. Give their places in this frame, in metres.");
  std::vector<Measurement> measured;
  for (const ObservableDescription &single : single_numbers())
    if (found.contains("heap_" + single.name))
      measured.push_back({single.name, 0, found.at("heap_" + single.name)});
  shape.append_to(measured, parameters.n_rings);
  return measured;
}

std::vector<ObservableDescription> observables()
{
  std::vector<ObservableDescription> all = single_numbers();
  all.push_back({"profile", "m", "ring, from the axis to the edge",
                 "mean height of the outline over all views and both sides"});
  all.push_back({"solid_fraction", "1", "layer, from the disc up",
                 "share of solid material around the axis, up to half of the disc's radius"});
  return all;
}

} // namespace eunoe::heap
