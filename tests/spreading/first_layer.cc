// The level of the measuring plate in the first pass: where it is, and what comes to lie on it.

#include <eunoe/processes/powder_spreading/apparatus.h>

#include "small_case.h"
#include "tests.h"

using namespace test;
using spreading::Apparatus;
using spreading::SpreadingParameters;

namespace {

constexpr double first = 100e-6, tolerance = 1e-12;

void examine_levels()
{
  SpreadingParameters p;
  p.length_factor = 0.02;
  const Apparatus level(p, first);
  p.first_thickness = first;
  const Apparatus lower(p, first);
  check_close("plate before the first pass", lower.plate->at(0.).centre.y, -first, tolerance);
  check_close("level by default", level.plate->at(0.).centre.y, 0., tolerance);
  check_close("in the last pass", p.plate_level(20), -first - 20. * p.layer_thickness, tolerance);
  p.plate_stroke_error = 0.1;
  check_close("with an error of all strokes", p.plate_level(20),
              -1.1 * (first + 20. * p.layer_thickness), tolerance);
}

struct Seen
{
  double mass = 0.;         ///< of layer 0
  double mass_of_next = 0.; ///< what comes with layer 1
  double density_of_next = 0.;
  std::size_t n_fractions = 0;
  double surface = 0., plate = 0.; ///< heights in the end (m)
};

Seen spread(const double thickness)
{
  Case run(small_spreading("results", "\n  set first layer thickness = " + format(thickness)));
  run.run();
  Seen seen;
  for (const Measurement &m : run->measurements()) {
    if (m.observable == "mass" && m.index == 0)
      seen.mass = m.value;
    if (m.observable == "mass" && m.index == 1)
      seen.mass_of_next = m.value - seen.mass;
    if (m.observable == "LRD" && m.index == 1)
      seen.density_of_next = m.value;
    if (m.observable == "solid_fraction")
      ++seen.n_fractions;
    if (m.observable == "surface_height")
      seen.surface += 0.25 * m.value;
  }
  seen.plate = -thickness - layer_thickness;
  return seen;
}

void examine_bed()
{
  const Seen level = spread(0.), lower = spread(first);
  // The room under the spreader is 1.9 times as high; in the lower one a pass takes most of the few
  // grains away that lie alone: the ratio was 1.3 to 17, with a mean of 4, for twenty seeds.
  const double ratio = lower.mass / level.mass;
  check("layer 0 takes what finds room", ratio > 1.2 && ratio < 20., format(ratio));
  for (const Seen &seen : {level, lower})
    check_relative("layer 1 is a layer of its thickness", seen.density_of_next,
                   seen.mass_of_next / (density * plate_length * slice_depth * layer_thickness),
                   1e-12);
  check("surface between plate and spreader",
        lower.surface > lower.plate && lower.surface < clearance, format(lower.surface));
  // The clearance of 1.1 layers lets powder stand above the level of the plates by a layer and
  // more.
  check("fractions up to the spreader", level.n_fractions == 3 && lower.n_fractions == 4);
}

} // namespace

EUNOE_MPI_TEST()
{
  examine_levels();
  examine_bed();
}
