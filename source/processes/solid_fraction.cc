#include <eunoe/processes/solid_fraction.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace eunoe {

namespace {

/// Area of a circle of radius @p r on one side of a line, from which its centre is @p d away: d = r
/// gives the whole circle, d = -r nothing.
double segment(const double d, const double r)
{
  const double x = std::clamp(d / r, -1., 1.);
  return r * r * (M_PI - std::acos(x) + x * std::sqrt(1. - x * x));
}

/// Common area of two circles whose centres are @p d apart.
double lens(const double d, const double a, const double b)
{
  const double least = std::min(a, b);
  if (d <= std::max(a, b) - least)
    return M_PI * least * least;
  if (d >= a + b)
    return 0.;
  // Two segments at the common chord, each on the far side of its circle's centre.
  const double from_a = (d * d + a * a - b * b) / (2. * d);
  return segment(-from_a, a) + segment(from_a - d, b);
}

/// Volume of a sphere of radius @p r at and between heights over its centre, where a horizontal
/// section of radius s has the area @p common(s). The angle of latitude makes the integrand smooth
/// at both poles; Gauss and Legendre's rule of eight places on each of two halves.
template <typename Area>
double volume_between(const double below, const double above, const double r, const Area &common)
{
  constexpr std::array<double, 4> places = {0.1834346424956498, 0.5255324099163290,
                                            0.7966664774136267, 0.9602898564975363};
  constexpr std::array<double, 4> weights = {0.3626837833783620, 0.3137066458778873,
                                             0.2223810344533745, 0.1012285362903763};
  const double begin = std::asin(std::max(-1., below / r)),
               end = std::asin(std::min(1., above / r));
  double sum = 0.;
  for (unsigned int half = 0; half < 2; ++half) {
    const double middle = begin + (0.25 + 0.5 * half) * (end - begin), reach = 0.25 * (end - begin);
    for (unsigned int k = 0; k < places.size(); ++k)
      for (const double side : {-1., 1.}) {
        const double radius = r * std::cos(middle + side * reach * places[k]);
        sum += weights[k] * reach * radius * common(radius);
      }
  }
  return sum;
}

} // namespace

Footprint Footprint::disc(const double radius)
{
  return {M_PI * radius * radius, [radius](const Vec3 &centre, double of_circle) {
            return lens(std::hypot(centre.x, centre.z), of_circle, radius);
          }};
}

Footprint Footprint::strip(const double x_begin, const double x_end, const double depth)
{
  return {(x_end - x_begin) * depth, [=](const Vec3 &centre, double of_circle) {
            return segment(x_end - centre.x, of_circle) - segment(x_begin - centre.x, of_circle);
          }};
}

SolidFraction::SolidFraction(Footprint footprint, const double floor, const double thickness,
                             const unsigned int n_layers)
    : footprint(std::move(footprint)), floor(floor), thickness(thickness), volumes(n_layers)
{
}

void SolidFraction::add(const Vec3 &centre, const double radius)
{
  if (footprint.common(centre, radius) <= 0.)
    return;
  for (unsigned int layer = 0; layer < n_layers(); ++layer) {
    const double below = floor + layer * thickness - centre.y, above = below + thickness;
    if (above > -radius && below < radius)
      volumes[layer] += volume_between(below, above, radius, [&](const double of_section) {
        return footprint.common(centre, of_section);
      });
  }
}

void SolidFraction::reduce(MPI_Comm comm)
{
  for (ExactSum &volume : volumes)
    volume.reduce(comm);
}

double SolidFraction::operator()(const unsigned int layer) const
{
  return volumes[layer].value() / (footprint.area * thickness);
}

} // namespace eunoe
