#include <eunoe/core/files.h>
#include <eunoe/core/problems.h>
#include <eunoe/core/table.h>
#include <eunoe/simulation/given_particles.h>
#include <eunoe/state/new_particle.h>

#include <cmath>

namespace eunoe {

namespace {

/// Place of the first of several names among the columns, -1 if there is none.
int first_of(const Table &table, const std::vector<std::string> &names)
{
  for (const std::string &name : names)
    if (table.column(name) >= 0)
      return table.column(name);
  return -1;
}

/// Where the numbers of a particle stand in a row.
struct Places
{
  int x, y, z, diameter, radius, mass;

  Places(const Table &table, const std::string &file)
      : x(first_of(table, {"x", "p_x"})), y(first_of(table, {"y", "p_y"})),
        z(first_of(table, {"z", "p_z"})), diameter(first_of(table, {"diameter", "diameters", "d"})),
        radius(first_of(table, {"radius", "r"})), mass(first_of(table, {"mass"}))
  {
    const std::string missing = x < 0                        ? "x"
                                : y < 0                      ? "y"
                                : z < 0                      ? "z"
                                : diameter < 0 && radius < 0 ? "diameter' or 'radius"
                                                             : "";
    if (!missing.empty())
      throw UserError(file + ":1: the header has no column '" + missing +
                      "'. Give the columns x, y, z and diameter, in metres, and perhaps mass, or "
                      "read other files with contrib/tools measure.");
  }
};

/// Refuses sizes in another unit than metres, radii that are given as diameters, and other powders.
void check_sizes(const std::vector<GivenParticle> &particles, const ParticleType &type,
                 const std::string &file)
{
  double cubes = 0.;
  for (const GivenParticle &particle : particles)
    cubes += std::pow(2. * particle.radius, 3.);
  const double given = std::cbrt(cubes / static_cast<double>(particles.size()));
  const auto sizes = type.sizes.make();
  constexpr double tolerance = 1.25; // scans miss the finest, and measure with an error
  if (given > tolerance * sizes->largest() || tolerance * given < sizes->smallest())
    throw UserError(file + ": the particles have a mean diameter of " + format(1e6 * given) +
                    " um (of equal volume), and the case's powder has diameters from " +
                    format(1e6 * sizes->smallest()) + " to " + format(1e6 * sizes->largest()) +
                    " um. Give metres (contrib/tools measure --scale turns other units), the right "
                    "column for diameters or radii, and a case of this powder.");
}

} // namespace

std::vector<GivenParticle> read_given_particles(const std::string &file, const ParticleType &type,
                                                MPI_Comm comm)
{
  const Table table = parse_table(read_file(file, comm), file);
  const Places places(table, file);
  std::vector<GivenParticle> particles;
  for (const std::vector<double> &row : table.rows) {
    GivenParticle particle;
    particle.centre = {row[places.x], row[places.y], row[places.z]};
    particle.radius = places.radius >= 0 ? row[places.radius] : 0.5 * row[places.diameter];
    particle.mass =
        places.mass >= 0 ? row[places.mass] : sphere_mass(particle.radius, type.density);
    const bool is_finite = std::isfinite(norm_square(particle.centre)) &&
                           std::isfinite(particle.radius) && std::isfinite(particle.mass);
    if (!is_finite || particle.radius <= 0. || particle.mass <= 0.)
      throw UserError(
          file + ": particle " + std::to_string(particles.size() + 1) +
          " has no finite place, or no positive size and mass. Leave it out, or correct "
          "it.");
    particles.push_back(particle);
  }
  if (particles.empty())
    throw UserError(file + ": it has no particles. Give a row for each of them.");
  check_sizes(particles, type, file);
  return particles;
}

} // namespace eunoe
