// Solid fractions by height of bodies whose sections are known: crystals, whose layers are all full
// or all alike; a sphere that layers, a disc's edge or a strip's edge cut, on any number of ranks.

#include <eunoe/processes/solid_fraction.h>

#include "tests.h"

#include <cmath>

using namespace test;

namespace {

bool is_mine(unsigned int k)
{
  int rank, n_ranks;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
  return static_cast<int>(k) % n_ranks == rank;
}

/// Volume of the cap of a sphere that is @p h high.
double cap(double h, double r)
{
  return M_PI * h * h * (r - h / 3.);
}

/// A face-centred cubic crystal of touching spheres has pi / sqrt(18) between planes of symmetry,
/// and a missing plane of it half in each layer beside.
void examine_crystal()
{
  const double r = 0.5, a = 2. * std::sqrt(2.) * r;
  SolidFraction disc(Footprint::disc(7.3 * a), 0., a, 4);
  SolidFraction strip(Footprint::strip(-5. * a, 5. * a, 16. * a), 0., a, 4);
  unsigned int k = 0;
  for (int i = -18; i <= 18; ++i)
    for (int l = -18; l <= 18; ++l)
      for (int j = 0; j <= 8; ++j)
        if ((i + j + l) % 2 == 0 && j != 4 && is_mine(++k)) {
          const Vec3 x = {0.5 * a * i, 0.5 * a * j, 0.5 * a * l};
          disc.add(x, r);
          if (l >= -16 && l < 16)
            strip.add(x, r);
        }
  disc.reduce(MPI_COMM_WORLD);
  strip.reduce(MPI_COMM_WORLD);
  const double full = M_PI / std::sqrt(18.);
  // Each plane of spheres holds half of the solid in a layer of the height a. The circle's edge
  // cuts the lattice at random.
  for (const unsigned int layer : {0u, 3u})
    check_relative("crystal over a disc", disc(layer), full, 2e-3);
  for (const unsigned int layer : {1u, 2u})
    check_relative("where a plane is missing, over a disc", disc(layer), 0.75 * full, 2e-3);
  for (const unsigned int layer : {0u, 3u})
    check_relative("crystal over a strip", strip(layer), full, 1e-6);
  for (const unsigned int layer : {1u, 2u})
    check_relative("where a plane is missing, over a strip", strip(layer), 0.75 * full, 1e-6);
}

/// A sphere of radius 1 around the height 1.3.
void examine_sphere()
{
  const auto volumes = [](const Footprint &footprint, const Vec3 &x) {
    SolidFraction one(footprint, 0., 1., 4);
    if (is_mine(0))
      one.add(x, 1.);
    one.reduce(MPI_COMM_WORLD);
    std::vector<double> result;
    for (unsigned int layer = 0; layer < 4; ++layer)
      result.push_back(one(layer) * footprint.area);
    return result;
  };
  const std::vector<double> inside = volumes(Footprint::disc(5.), {2., 1.3, 3.});
  const double all = 4. / 3. * M_PI;
  check_relative("sphere, lowest layer", inside[0], cap(0.7, 1.), 1e-9);
  check_relative("sphere, second layer", inside[1], all - cap(0.7, 1.) - cap(0.3, 1.), 1e-9);
  check_relative("sphere, third layer", inside[2], cap(0.3, 1.), 1e-9);
  check("sphere, layer above", inside[3] == 0.);

  // A strip cuts it at a plane.
  const std::vector<double> cut = volumes(Footprint::strip(0., 9., 1.), {0.4, 1.3, 7.});
  check_relative("sphere over a strip's edge", cut[0] + cut[1] + cut[2], all - cap(0.6, 1.), 1e-3);
  check("sphere beside a strip", volumes(Footprint::strip(0., 9., 1.), {-1.1, 1.3, 7.})[1] == 0.);
  // A sphere around a thin vertical cylinder: sphere less what a bead with a cylindrical hole
  // keeps.
  const std::vector<double> core = volumes(Footprint::disc(0.6), {0., 1.3, 0.});
  check_relative("a cylinder's part of a sphere", core[0] + core[1] + core[2],
                 all * (1. - 0.8 * 0.8 * 0.8), 1e-3);
  // A cylinder so wide that its edge is almost a plane, through the sphere's middle.
  const std::vector<double> half = volumes(Footprint::disc(1e4), {0., 1.3, 1e4});
  check_relative("half of a sphere", half[0] + half[1] + half[2], 0.5 * all, 1e-3);
}

/// In a layer so thin that it cuts a disc out of the sphere, what a disc has of it is a lens of two
/// circles, whose area is known: with equal radii and a distance of one of them, and where the
/// smaller circle's centre lies beyond the common chord.
void examine_lens()
{
  const auto area = [](double radius, double distance) {
    constexpr double thickness = 1e-3;
    SolidFraction one(Footprint::disc(radius), -0.5 * thickness, thickness, 1);
    if (is_mine(0))
      one.add({distance, 0., 0.}, 1.);
    one.reduce(MPI_COMM_WORLD);
    return one(0) * M_PI * radius * radius;
  };
  check_relative("lens of equal circles", area(1., 1.), 2. * M_PI / 3. - 0.5 * std::sqrt(3.), 1e-5);
  // Two sectors less the kite of the centres and the ends of the chord.
  const double b = 2., d = 1.5, x = (d * d + 1. - b * b) / (2. * d), y = std::sqrt(1. - x * x);
  check_relative("lens of a small circle in a large one", area(b, d),
                 std::acos(x) + b * b * std::acos((d - x) / b) - d * y, 1e-5);
}

} // namespace

EUNOE_MPI_TEST()
{
  examine_crystal();
  examine_sphere();
  examine_lens();
}
