#include <eunoe/engine/ledger.h>
#include <eunoe/processes/powder_spreading/plate_measurement.h>
#include <eunoe/simulation/parameters.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace eunoe::spreading {

namespace {

/// Number of layers, of the thickness of one, up to where the last pass can leave powder.
unsigned int layers_of_bed(const SpreadingParameters &p)
{
  if (p.layer_thickness <= 0.)
    return p.n_layers;
  const double under_spreader = (p.first_thickness + p.clearance) / p.layer_thickness;
  const double rounding = 1e-6;
  return p.n_layers - 1 +
         std::max(1u, static_cast<unsigned int>(std::ceil(under_spreader - rounding)));
}

/// Columns of the surface's heights, in parts of the smallest diameter.
constexpr double column_width = 0.25;

double smallest_diameter(const PhysicalProperties &physics)
{
  double smallest = std::numeric_limits<double>::max();
  for (const ParticleType &type : physics.types)
    smallest = std::min(smallest, type.sizes.make()->smallest());
  return smallest;
}

/// What lies on the plate at one of several moments.
struct OnPlate
{
  Tally present;
  ExactSum volume;

  OnPlate(const std::vector<GivenParticle> &particles, const Apparatus &apparatus,
          const double plate_height)
  {
    for (const GivenParticle &particle : particles)
      if (apparatus.is_over_plate(particle.centre, plate_height)) {
        present.count(particle.mass);
        volume += sphere_mass(particle.radius, 1.);
      }
  }

  void append_to(std::vector<Measurement> &measured, const unsigned int layer) const
  {
    measured.push_back({"mass", static_cast<int>(layer), present.mass.value()});
    measured.push_back({"particles", static_cast<int>(layer), static_cast<double>(present.number)});
  }
};

/// What lies beside the slice would count to the masses of its plate.
void check_depth(const std::vector<GivenParticle> &particles, const Apparatus &apparatus,
                 const double plate_height)
{
  for (const GivenParticle &particle : particles)
    if (apparatus.is_over_plate(particle.centre, plate_height) &&
        (particle.centre.z < -particle.radius ||
         particle.centre.z > apparatus.depth + particle.radius))
      throw UserError(
          "On the measuring plate there is a particle at z = " + format(particle.centre.z) +
          " m, and the apparatus reaches from z = 0 to its depth, " + format(apparatus.depth) +
          " m. Give what lies between these, wrapped if the slice is periodic, or a case of "
          "that depth.");
}

/// Masses and relative densities, of all layers one after the other.
void append_layers(const std::vector<OnPlate> &layers, const double full,
                   std::vector<Measurement> &measured)
{
  for (unsigned int k = 0; k < layers.size(); ++k) {
    layers[k].append_to(measured, k);
    const RelativeDensities densities(k, full, layers[k].volume.value(),
                                      layers[k > 0 ? k - 1 : 0].volume.value(),
                                      layers[k > 0 ? 1 : 0].volume.value());
    if (std::isfinite(densities.layer))
      measured.push_back({"LRD", static_cast<int>(k), densities.layer});
    if (std::isfinite(densities.cumulative))
      measured.push_back({"CRD", static_cast<int>(k), densities.cumulative});
  }
}

} // namespace

PlateMeasurement::PlateMeasurement(const SpreadingParameters &parameters,
                                   const Apparatus &apparatus, const PhysicalProperties &physics,
                                   const bool is_periodic, const double plate_height)
    : n_bins(parameters.profile_bins), profile({apparatus.x_plate, apparatus.x_plate_end,
                                                apparatus.depth, is_periodic, plate_height},
                                               n_bins, column_width * smallest_diameter(physics)),
      density(Footprint::strip(apparatus.x_plate, apparatus.x_plate_end, apparatus.depth),
              plate_height, parameters.layer_thickness, layers_of_bed(parameters))
{
}

void PlateMeasurement::add(const Vec3 &centre, const double radius, const double mass)
{
  profile.add(centre, radius, mass);
  density.add(centre, radius);
}

void PlateMeasurement::reduce(MPI_Comm comm)
{
  profile.reduce(comm);
  density.reduce(comm);
}

void PlateMeasurement::append_to(std::vector<Measurement> &measured) const
{
  for (unsigned int bin = 0; bin < n_bins; ++bin)
    measured.push_back({"surface_height", static_cast<int>(bin), profile.height(bin)});
  measured.push_back({"surface_roughness", 0, profile.roughness()});
  for (unsigned int bin = 0; bin < n_bins; ++bin)
    if (std::isfinite(profile.mean_diameter(bin)))
      measured.push_back({"mean_diameter", static_cast<int>(bin), profile.mean_diameter(bin)});
  for (unsigned int layer = 0; layer < density.n_layers(); ++layer)
    measured.push_back({"solid_fraction", static_cast<int>(layer), density(layer)});
}

RelativeDensities::RelativeDensities(const unsigned int number, const double full,
                                     const double volume, const double last, const double first)
    : layer(number >= 1 ? (volume - last) / full : std::numeric_limits<double>::quiet_NaN()),
      cumulative(number >= 2 ? (volume - first) / (full * (number - 1))
                             : std::numeric_limits<double>::quiet_NaN())
{
}

std::vector<Measurement> SpreadingParameters::measure(
    const Parameters &parameters, const std::vector<std::vector<GivenParticle>> &moments) const
{
  if (moments.size() != 1 && moments.size() != n_layers)
    throw UserError("There are " + std::to_string(moments.size()) +
                    " files of particles, and the case has " + std::to_string(n_layers) +
                    " layers. Give the file after the last layer, or one for each layer.");
  const Apparatus apparatus(*this, parameters.physics.largest_diameter());
  std::vector<OnPlate> layers;
  for (std::size_t k = 0; k < moments.size(); ++k) {
    const double level = plate_level(n_layers - moments.size() + k);
    check_depth(moments[k], apparatus, level);
    layers.emplace_back(moments[k], apparatus, level);
  }
  if (layers.back().present.number == 0)
    throw UserError(
        "None of the " + std::to_string(moments.back().size()) +
        " particles lies over the measuring plate, from x = " + format(apparatus.x_plate) + " to " +
        format(apparatus.x_plate_end) + " m and above y = " + format(plate_level(n_layers - 1)) +
        " m. Give their places in this frame, in metres.");
  std::vector<Measurement> measured;
  if (moments.size() == n_layers)
    append_layers(layers, apparatus.plate_area() * layer_thickness, measured);
  else
    layers.back().append_to(measured, n_layers - 1);
  PlateMeasurement plate(*this, apparatus, parameters.physics, !side_walls,
                         plate_level(n_layers - 1));
  for (const GivenParticle &particle : moments.back())
    plate.add(particle.centre, particle.radius, particle.mass);
  plate.append_to(measured);
  return measured;
}

} // namespace eunoe::spreading
