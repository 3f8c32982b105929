#include <eunoe/processes/powder_spreading/plate_profile.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace eunoe::spreading {

namespace {

/// Width of columns of which every rank can hold all (m).
double width_of_columns(const PlateProfile::Area &area, const double finest)
{
  constexpr double most_columns = 1e7;
  return std::max(finest, std::sqrt((area.x_end - area.x_begin) * area.depth / most_columns));
}

} // namespace

PlateProfile::PlateProfile(const Area &area, const unsigned int n_bins, const double finest)
    : area(area), columns_per_bin(static_cast<unsigned int>(std::ceil(
                      (area.x_end - area.x_begin) / n_bins / width_of_columns(area, finest)))),
      n_z(static_cast<unsigned int>(std::ceil(area.depth / width_of_columns(area, finest)))),
      width_x((area.x_end - area.x_begin) / (n_bins * columns_per_bin)), width_z(area.depth / n_z),
      heights(static_cast<std::size_t>(n_bins) * columns_per_bin * n_z, area.floor), bins(n_bins)
{
}

void PlateProfile::add(const Vec3 &centre, const double radius, const double mass)
{
  const auto n_x = static_cast<int>(bins.size() * columns_per_bin);
  const auto columns_z = static_cast<int>(n_z);
  const auto column = [](double place, double width) {
    return static_cast<int>(std::floor(place / width));
  };
  const double x = centre.x - area.x_begin, reach = area.x_end - area.x_begin + radius;
  if (!(x > -radius && x < reach) || centre.y <= area.floor)
    return;
  if (x >= 0. && centre.x < area.x_end) {
    Bin &bin = bins[std::min<std::size_t>(column(x, columns_per_bin * width_x), bins.size() - 1)];
    bin.mass += mass;
    bin.moment += mass * 2. * radius;
  }
  const double z =
      area.is_periodic ? centre.z - area.depth * std::floor(centre.z / area.depth) : centre.z;
  const int last_x = std::min(column(x + radius, width_x), n_x - 1);
  for (int i = std::max(column(x - radius, width_x), 0); i <= last_x; ++i)
    for (int k = column(z - radius, width_z); k <= column(z + radius, width_z); ++k) {
      if (!area.is_periodic && (k < 0 || k >= columns_z))
        continue;
      const double off_x = (i + 0.5) * width_x - x, off_z = (k + 0.5) * width_z - z;
      const double chord = radius * radius - off_x * off_x - off_z * off_z;
      const int row = ((k % columns_z) + columns_z) % columns_z;
      double &height = heights[static_cast<std::size_t>(i) * n_z + row];
      if (chord > 0.)
        height = std::max(height, centre.y + std::sqrt(chord));
    }
}

void PlateProfile::reduce(MPI_Comm comm)
{
  MPI_Allreduce(MPI_IN_PLACE, heights.data(), static_cast<int>(heights.size()), MPI_DOUBLE, MPI_MAX,
                comm);
  for (Bin &bin : bins) {
    bin.mass.reduce(comm);
    bin.moment.reduce(comm);
  }
}

double PlateProfile::height(const unsigned int bin) const
{
  const std::size_t n = static_cast<std::size_t>(columns_per_bin) * n_z;
  double sum = 0.;
  for (std::size_t k = bin * n; k < (bin + 1) * n; ++k)
    sum += heights[k];
  return sum / static_cast<double>(n);
}

double PlateProfile::roughness() const
{
  double mean = 0., squares = 0.;
  for (const double height : heights)
    mean += height / static_cast<double>(heights.size());
  for (const double height : heights)
    squares += (height - mean) * (height - mean);
  return std::sqrt(squares / static_cast<double>(heights.size()));
}

double PlateProfile::mean_diameter(const unsigned int bin) const
{
  const double mass = bins[bin].mass.value();
  return mass > 0. ? bins[bin].moment.value() / mass : std::numeric_limits<double>::quiet_NaN();
}

} // namespace eunoe::spreading
