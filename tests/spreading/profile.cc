// The profile along the plate for spheres at known places: the volume below the surface and the
// mean diameters in closed form, across the period as in the middle, on any number of ranks.

#include <eunoe/processes/powder_spreading/plate_profile.h>

#include "tests.h"

using namespace test;
using spreading::PlateProfile;

namespace {

constexpr double x0 = 1e-3, length = 0.8e-3, depth = 0.3e-3, ground = -0.2e-3, r = 40e-6;
constexpr unsigned int n_bins = 4;
constexpr double bin_area = length / n_bins * depth;

/// Volume over the plate and below the upper half of a sphere.
double volume_below(double y)
{
  return M_PI * r * r * (y - ground) + 2. / 3. * M_PI * r * r * r;
}

bool is_mine(unsigned int k)
{
  int rank, n_ranks;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
  return static_cast<int>(k) % n_ranks == rank;
}

PlateProfile profile_of(const std::vector<Vec3> &centres, bool is_periodic)
{
  PlateProfile profile({x0, x0 + length, depth, is_periodic, ground}, n_bins, 1e-6);
  for (unsigned int k = 0; k < centres.size(); ++k)
    if (is_mine(k))
      profile.add(centres[k], r, k + 1.);
  profile.reduce(MPI_COMM_WORLD);
  return profile;
}

} // namespace

EUNOE_MPI_TEST()
{
  const double y = ground + r, middle = 0.5 * depth;

  const PlateProfile one = profile_of({{x0 + 0.1e-3, y, middle}}, true);
  const double raised = volume_below(y) / bin_area;
  check_relative("a sphere in the first bin", one.height(0) - ground, raised, 2e-3);
  check_close("no sphere in the second", one.height(1), ground, 1e-15);
  check_close("its diameter", one.mean_diameter(0), 2. * r, 1e-18);
  check("no diameter in an empty bin", std::isnan(one.mean_diameter(1)));

  const PlateProfile across = profile_of({{x0 + 0.1e-3, y, 3. * depth}}, true);
  check_relative("across the period", across.height(0) - ground, one.height(0) - ground, 1e-9);
  const PlateProfile cut = profile_of({{x0 + 0.1e-3, y, 0.}}, false);
  check_relative("cut in half without a period", cut.height(0) - ground,
                 0.5 * (one.height(0) - ground), 1e-9);

  const PlateProfile shared = profile_of({{x0 + 0.2e-3, y, middle}}, true);
  check_relative("on the border of two bins", shared.height(0) - ground, 0.5 * raised, 4e-3);
  check_close("both alike", shared.height(0), shared.height(1), 1e-15);

  const PlateProfile hidden = profile_of({{x0 + 0.1e-3, y + 3. * r, middle},
                                          {x0 + 0.1e-3, y, middle},
                                          {x0 - 2. * r, y, middle},
                                          {x0 + 0.5e-3, ground - 2. * r, middle}},
                                         true);
  check_relative("from above only the upper one is seen", hidden.height(0) - ground,
                 volume_below(y + 3. * r) / bin_area, 2e-3);
  check("nothing beside or below the plate",
        std::abs(hidden.height(2) - ground) < 1e-15 && std::isnan(hidden.mean_diameter(2)));
  const PlateProfile edge = profile_of({{x0 - 0.5 * r, y, middle}}, true);
  check("a sphere whose centre is off the plate is seen, not weighed",
        edge.height(0) > ground && std::isnan(edge.mean_diameter(0)));

  PlateProfile two_sizes({x0, x0 + length, depth, true, ground}, n_bins, 1e-6);
  if (is_mine(0))
    two_sizes.add({x0 + 0.7e-3, y, middle}, r, 1.);
  if (is_mine(1))
    two_sizes.add({x0 + 0.7e-3, y, middle}, 2. * r, 8.);
  two_sizes.reduce(MPI_COMM_WORLD);
  check_relative("mean diameter by mass", two_sizes.mean_diameter(3), 2. * r * (1. + 16.) / 9.,
                 1e-14);

  const double share = (one.height(0) - ground) / n_bins;
  double mean = 0.;
  for (unsigned int bin = 0; bin < n_bins; ++bin)
    mean += one.height(bin) / n_bins;
  check_relative("mean height", mean - ground, share, 1e-9);
  // Second moment of the upper half of a sphere over the floor: integral of (r + c)^2 over its
  // disc.
  const double squares = M_PI * r * r * r * r * (1. + 4. / 3. + 0.5) / (n_bins * bin_area);
  check_relative("roughness", one.roughness(), std::sqrt(squares - share * share), 2e-3);
}
