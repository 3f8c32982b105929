// The outlines of heaps of known shape: a cone of spheres has its known base angle, a single sphere
// its known projected area and place in every view, on any number of ranks.

#include <eunoe/processes/heap/silhouettes.h>
#include <eunoe/processes/heap/standing_height.h>

#include "tests.h"

using namespace test;
using heap::Silhouettes;
using heap::StandingHeight;

namespace {

constexpr double D = 2e-3, degree = M_PI / 180.;

bool is_mine(unsigned int k)
{
  int rank, n_ranks;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
  return static_cast<int>(k) % n_ranks == rank;
}

/// Area of a triangle of base D and base angle @p slope, less the area that spheres of radius @p r
/// inside it cannot reach: at the tip, and at both ends of the base, where the outermost sphere
/// touches base and side.
double rounded_triangle(const double slope, const double r)
{
  const double l = r / std::tan(0.5 * slope), c = std::cos(slope), s = std::sin(slope);
  const double end = 0.5 * std::tan(slope) * l * l * c * c - r * r * (1. - s) -
                     0.5 * r * r * (M_PI / 2. - slope - s * c);
  return 0.25 * D * D * std::tan(slope) - 2. * end - r * r * (std::tan(slope) - slope);
}

/// A cone over the whole disc, made of small spheres that touch its surface from within.
void examine_cone(const double angle)
{
  Silhouettes views(D, 0.1e-3, 16, 100, 2e-6);
  const double r = 0.01 * D / 2., slope = angle * degree;
  const unsigned int n_turns = 361, n_heights = 1600;
  // Centres lie on the cone that is shifted inwards by r.
  const double highest = D / 2. * std::tan(slope) - r / std::cos(slope);
  for (unsigned int t = 0; t < n_turns; ++t)
    for (unsigned int h = 0; h <= n_heights; ++h) {
      const double y = r + (highest - r) * h / n_heights;
      const double off_axis = (highest - y) / std::tan(slope);
      const double turn = 2. * M_PI * t / n_turns;
      if (is_mine(t))
        views.add({off_axis * std::cos(turn), y, off_axis * std::sin(turn)}, r);
    }
  views.reduce(MPI_COMM_WORLD);

  double worst = 0., off_area = 0., off_height = 0.;
  for (unsigned int view = 0; view < views.n_views(); ++view) {
    const double area = views.area(view);
    off_area = std::max(off_area, std::abs(area / rounded_triangle(slope, r) - 1.));
    worst = std::max(worst, std::abs(views.base_angle(area) - angle));
    off_height = std::max(off_height, std::abs(views.height(view) - highest - r));
  }
  // The tip is a sphere. Columns of 2 um sample it up to 1 um = 0.1 r off its middle, where it is
  // 0.5 (0.1 r)^2 / r lower.
  check_close("area of a cone", off_area, 0., 3e-4);
  check_close("base angle of a cone", worst, 0., 0.05);
  check_close("height of a cone", off_height, 0., 6e-3 * r);
  double off_line = 0., spread = 0.;
  for (const Silhouettes::Bin &bin : views.profile()) {
    const double line = (D / 2. - std::abs(bin.x)) * std::tan(slope);
    const double from_edge = D / 2. - std::abs(bin.x);
    if (std::abs(bin.x) > 2. * r && from_edge > r / std::tan(0.5 * slope) + r)
      off_line = std::max(off_line, std::abs(bin.mean - line));
    spread = std::max(spread, bin.spread);
  }
  check_close("profile of a cone", off_line, 0., 0.02 * r);
  const std::vector<double> rings = views.rings(5);
  for (const unsigned int ring : {1u, 2u, 3u}) {
    const double line = D / 2. * (1. - (ring + 0.5) / 5.) * std::tan(slope);
    check_close("ring of a cone", rings[ring], line, 0.02 * r);
  }
  check("spread of a cone", spread < 0.05 * r, std::to_string(spread / r));
}

/// Rings that are narrower than the columns of the outlines.
void examine_fine_rings()
{
  constexpr unsigned int n_rings = 200;
  Silhouettes views(D, 0., 16, 10, 20e-6);
  // A plain of spheres, 0.1 mm high.
  for (int i = -120; i <= 120; ++i)
    for (int k = -120; k <= 120; ++k)
      if (is_mine(static_cast<unsigned int>(i + 120)))
        views.add({1e-5 * i, 0.05e-3, 1e-5 * k}, 0.05e-3);
  views.reduce(MPI_COMM_WORLD);
  double off = 0.;
  for (const double height : views.rings(n_rings))
    off = std::max(off, std::abs(height - 0.1e-3));
  check_close("rings narrower than columns", off, 0., 2e-6);
}

/// A sphere far off the axis is seen at another place in every view.
void examine_sphere()
{
  const double r = 0.1e-3, y = 0.3e-3, off_axis = 0.6e-3, turn = 40. * degree;
  Silhouettes views(D, r, 16, 400, 0.2e-6);
  if (is_mine(1))
    views.add({off_axis * std::cos(turn), y, off_axis * std::sin(turn)}, r);
  views.reduce(MPI_COMM_WORLD);
  double worst = 0.;
  for (unsigned int view = 0; view < views.n_views(); ++view)
    worst = std::max(worst, std::abs(views.area(view) / (2. * r * y + M_PI / 2. * r * r) - 1.));
  check_close("area below a sphere", worst, 0., 1e-3);

  // One view alone looks along z.
  Silhouettes one(D, r, 1, 400, 0.2e-6);
  if (is_mine(0))
    one.add({0.25e-3, y, -0.4e-3}, r);
  one.reduce(MPI_COMM_WORLD);
  double sum = 0., moment = 0.;
  for (const Silhouettes::Bin &bin : one.profile()) {
    sum += bin.mean;
    moment += bin.mean * bin.x;
  }
  check_close("place of a sphere in the profile", moment / sum, 0.25e-3, 0.2e-6);
}

/// A row of spheres is black where both views see it, and grey where one does.
void examine_map()
{
  Silhouettes views(D, 0., 2, 100, 20e-6);
  // Seen along z, the row of spheres along z is narrow; seen along x, wide.
  for (unsigned int k = 0; k <= 100; ++k)
    if (is_mine(k))
      views.add({0., 0.1e-3, (0.01 * k - 0.5) * 1.6e-3}, 0.1e-3);
  views.reduce(MPI_COMM_WORLD);
  const std::string map = views.map();
  unsigned int n_x = 0, n_y = 0;
  std::sscanf(map.c_str(), "P5\n#%*[^\n]\n%u %u", &n_x, &n_y);
  check("size of the map", n_x == 100 && n_y == 12,
        std::to_string(n_x) + " x " + std::to_string(n_y));
  const auto grey = [&](double x, double y) {
    const auto column = static_cast<std::size_t>((x + D / 2.) / 20e-6);
    const auto row = n_y - 1 - static_cast<std::size_t>(y / 20e-6);
    return static_cast<unsigned char>(map[map.size() - n_x * n_y + row * n_x + column]);
  };
  check("seen in all views", grey(0.01e-3, 0.05e-3) == 0, std::to_string(grey(0.01e-3, 0.05e-3)));
  check("seen in half of them", grey(0.51e-3, 0.05e-3) == 128,
        std::to_string(grey(0.51e-3, 0.05e-3)));
  check("seen in none", grey(0.95e-3, 0.05e-3) == 255, std::to_string(grey(0.95e-3, 0.05e-3)));
}

/// A column of grains, of which no two neighbours touch exactly, and one that flies above it.
void examine_standing_height()
{
  constexpr double d = 0.1e-3;
  StandingHeight stands(3e-3, d), empty(3e-3, d);
  for (unsigned int k = 0; k < 12; ++k)
    if (is_mine(k))
      stands.see((0.5 + 0.99 * k) * d);
  for (const double flies : {1.5e-3, 2.9e-3, 5e-3})
    stands.see(flies);
  stands.reduce(MPI_COMM_WORLD);
  empty.reduce(MPI_COMM_WORLD);
  const double top = stands(), highest = (0.5 + 0.99 * 11) * d;
  check("the column stands", highest < top && top < highest + 1.01 * d, std::to_string(top));
  check("nothing stands", empty() == 0.);
}

} // namespace

EUNOE_MPI_TEST()
{
  for (const double angle : {20., 37.5, 60.})
    examine_cone(angle);
  examine_fine_rings();
  examine_sphere();
  examine_map();
  examine_standing_height();
}
