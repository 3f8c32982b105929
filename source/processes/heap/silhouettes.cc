#include <eunoe/processes/heap/silhouettes.h>

#include <algorithm>

namespace eunoe::heap {

namespace {

/// Width of columns of which every rank can hold all, of all views (m).
double width_of_columns(const double length, const unsigned int n_views, const double finest)
{
  constexpr double most_columns = 1e7;
  return std::max(finest, n_views * length / most_columns);
}

} // namespace

Silhouettes::Silhouettes(const double disc_diameter, const double overhang,
                         const unsigned int n_views, const unsigned int n_bins, const double finest)
    : disc_diameter(disc_diameter), n_bins(n_bins),
      columns_per_bin(static_cast<unsigned int>(
          std::ceil(disc_diameter / n_bins / width_of_columns(disc_diameter, n_views, finest)))),
      width(disc_diameter / (n_bins * columns_per_bin))
{
  const auto beyond = static_cast<unsigned int>(std::ceil(overhang / width));
  n_columns = n_bins * columns_per_bin + 2 * beyond;
  left = -0.5 * n_columns * width;
  heights.assign(static_cast<std::size_t>(n_views) * n_columns, 0.);
}

void Silhouettes::add(const Vec3 &centre, const double radius)
{
  for (unsigned int view = 0; view < n_views(); ++view) {
    const double along =
        centre.x * std::cos(direction(view)) + centre.z * std::sin(direction(view));
    const double first = std::floor((along - radius - left) / width);
    const double last = std::ceil((along + radius - left) / width);
    const auto begin = static_cast<unsigned int>(std::clamp(first, 0., 1. * n_columns));
    const auto end = static_cast<unsigned int>(std::clamp(last, 0., 1. * n_columns));
    double *const outline = heights.data() + static_cast<std::size_t>(view) * n_columns;
    for (unsigned int column = begin; column < end; ++column) {
      const double off = left + (column + 0.5) * width - along;
      const double chord = radius * radius - off * off;
      if (chord > 0.)
        outline[column] = std::max(outline[column], centre.y + std::sqrt(chord));
    }
  }
}

void Silhouettes::reduce(MPI_Comm comm)
{
  MPI_Allreduce(MPI_IN_PLACE, heights.data(), static_cast<int>(heights.size()), MPI_DOUBLE, MPI_MAX,
                comm);
}

double Silhouettes::area(const unsigned int view) const
{
  double sum = 0.;
  for (unsigned int column = 0; column < n_columns; ++column)
    sum += heights[static_cast<std::size_t>(view) * n_columns + column];
  return sum * width;
}

double Silhouettes::height(const unsigned int view) const
{
  const auto begin = heights.begin() + static_cast<std::ptrdiff_t>(view) * n_columns;
  return *std::max_element(begin, begin + n_columns);
}

double Silhouettes::base_angle(const double area) const
{
  return std::atan(4. * area / (disc_diameter * disc_diameter)) * 180. / M_PI;
}

std::vector<Silhouettes::Bin> Silhouettes::profile() const
{
  const unsigned int beyond = (n_columns - n_bins * columns_per_bin) / 2;
  std::vector<Bin> profile;
  for (unsigned int bin = 0; bin < n_bins; ++bin) {
    double sum = 0., squares = 0.;
    std::vector<double> of_views;
    for (unsigned int view = 0; view < n_views(); ++view) {
      double height = 0.;
      for (unsigned int k = 0; k < columns_per_bin; ++k)
        height += heights[static_cast<std::size_t>(view) * n_columns + beyond +
                          bin * columns_per_bin + k];
      of_views.push_back(height / columns_per_bin);
      sum += of_views.back();
    }
    const double mean = sum / n_views();
    for (const double height : of_views)
      squares += (height - mean) * (height - mean);
    const double spread = n_views() > 1 ? std::sqrt(squares / (n_views() - 1)) : 0.;
    profile.push_back({((bin + 0.5) / n_bins - 0.5) * disc_diameter, mean, spread});
  }
  return profile;
}

std::vector<double> Silhouettes::rings(const unsigned int n_rings) const
{
  std::vector<double> sums(n_rings, 0.);
  std::vector<unsigned int> counts(n_rings, 0);
  for (std::size_t k = 0; k < heights.size(); ++k) {
    const double off_axis = std::abs(left + (static_cast<double>(k % n_columns) + 0.5) * width);
    const auto ring = static_cast<unsigned int>(off_axis / (0.5 * disc_diameter) * n_rings);
    if (ring < n_rings) {
      sums[ring] += heights[k];
      ++counts[ring];
    }
  }
  // A ring that is narrower than a column may have none of its own: it takes the nearest ones.
  for (unsigned int ring = 0; ring < n_rings; ++ring)
    if (counts[ring] == 0) {
      const double middle = (ring + 0.5) / n_rings * 0.5 * disc_diameter;
      for (const double place : {-middle, middle}) {
        const auto column = static_cast<unsigned int>(
            std::clamp(std::floor((place - left) / width), 0., n_columns - 1.));
        for (unsigned int view = 0; view < n_views(); ++view) {
          sums[ring] += heights[static_cast<std::size_t>(view) * n_columns + column];
          ++counts[ring];
        }
      }
    }
  for (unsigned int ring = 0; ring < n_rings; ++ring)
    sums[ring] /= counts[ring];
  return sums;
}

std::string Silhouettes::map() const
{
  constexpr unsigned int widest = 600;
  const unsigned int columns_per_pixel = (n_columns + widest - 1) / widest;
  const unsigned int n_x = n_columns / columns_per_pixel;
  const double pixel = columns_per_pixel * width;
  const double highest = *std::max_element(heights.begin(), heights.end());
  const auto n_y = static_cast<unsigned int>(std::ceil(1.1 * highest / pixel)) + 1;

  char head[200];
  std::snprintf(head, sizeof head,
                "P5\n# left edge at x = %.9g m, base line at the lower edge, pixel of %.9g m\n%u "
                "%u\n255\n",
                left, pixel, n_x, n_y);
  std::string map = head;
  for (unsigned int row = n_y; row-- > 0;)
    for (unsigned int k = 0; k < n_x; ++k) {
      unsigned int covered = 0;
      for (unsigned int view = 0; view < n_views(); ++view)
        for (unsigned int c = 0; c < columns_per_pixel; ++c)
          if (heights[static_cast<std::size_t>(view) * n_columns + k * columns_per_pixel + c] >
              (row + 0.5) * pixel)
            ++covered;
      const double share = static_cast<double>(covered) / (n_views() * columns_per_pixel);
      map += static_cast<char>(std::lround(255. * (1. - share)));
    }
  return map;
}

} // namespace eunoe::heap
