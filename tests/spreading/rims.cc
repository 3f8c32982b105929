// Rims between the measuring plate and its gaps: where they stand, that the gaps have walls on both
// sides then, and that they hold the bed, which without them slopes into the gaps.

#include <eunoe/processes/powder_spreading/apparatus.h>

#include "small_case.h"
#include "tests.h"

#include <algorithm>
#include <set>

using namespace test;
using spreading::Apparatus;
using spreading::SpreadingParameters;

namespace {

constexpr double gap = 0.4e-3, rim = 0.05e-3, tolerance = 1e-12;

/// Height of the lowest edge of a solid at an x (m).
double foot_at(const Solid &solid, const double x)
{
  double lowest = 1.;
  for (const Vec3 &corner : solid.shape->triangles())
    if (std::abs(corner.x - x) < tolerance)
      lowest = std::min(lowest, corner.y);
  return lowest;
}

const Solid &solid_of(const std::vector<Solid> &solids, const std::string &name)
{
  return *std::find_if(solids.begin(), solids.end(),
                       [&](const Solid &solid) { return solid.name == name; });
}

void examine_places()
{
  SpreadingParameters p;
  p.length_factor = 0.02;
  p.gap = gap;
  const Apparatus open(p, 100e-6);
  std::vector<Solid> solids;
  open.add_solids(solids, 1);
  check("no rims of width 0", std::none_of(solids.begin(), solids.end(), [](const Solid &solid) {
          return solid.name == "rims";
        }));
  check_close("plate beside the gap", open.x_plate, open.x_gap + gap, tolerance);
  check_close("edge of the transfer plate", foot_at(solid_of(solids, "transfer plate"), open.x_gap),
              -p.lip, tolerance);

  p.rim = rim;
  const Apparatus held(p, 100e-6);
  solids.clear();
  held.add_solids(solids, 1);
  const Solid &rims = solids.back();
  check("rims", rims.name == "rims");
  std::set<double> walls;
  double highest = -1., lowest = 1.;
  for (const Vec3 &corner : rims.shape->triangles()) {
    walls.insert(corner.x);
    highest = std::max(highest, corner.y);
    lowest = std::min(lowest, corner.y);
  }
  const std::vector<double> x(walls.begin(), walls.end());
  check("four walls", x.size() == 4);
  check_close("wall at the first gap", x[0], held.x_gap + gap, tolerance);
  check_close("wall at the plate's left end", x[1], held.x_plate, tolerance);
  check_close("wall at the plate's right end", x[2], held.x_plate_end, tolerance);
  check_close("wall at the second gap", x[3], held.x_exit - gap, tolerance);
  check_close("width", x[1] - x[0], rim, tolerance);
  check_close("level with the other plates", highest, 0., tolerance);
  check("deeper than the plate goes", lowest < -p.n_layers * p.layer_thickness);
  check_close("as deep beside the transfer plate",
              foot_at(solid_of(solids, "transfer plate"), held.x_gap), lowest, tolerance);
  check_close("as deep beside the exit plate", foot_at(solid_of(solids, "exit plate"), held.x_exit),
              lowest, tolerance);
  check_close("length of the plate", held.x_plate_end - held.x_plate,
              open.x_plate_end - open.x_plate, tolerance);
}

struct Seen
{
  double on_plate = 0.;       ///< mass (kg)
  double deepest_in_rim = 0.; ///< over the radius
  double deepest_beside = 0.; ///< overlap with the outer walls, over the radius
};

/// Layers on a plate between wide gaps.
Seen spread(const double width)
{
  Case run(small_spreading("results", R"(
  set gap              = 0.4e-3
  set lip height       = 0.1e-3
  set number of layers = 5
  set rim width        = )" + std::to_string(width)));
  SpreadingParameters p;
  p.w1 = 0.6e-3;
  p.w2 = 0.2e-3;
  p.w3 = plate_length;
  p.length_factor = 1.;
  p.gap = gap;
  p.rim = width;
  const Apparatus apparatus(p, 80e-6);
  Seen seen;
  run.run([&](Simulation &simulation) {
    const ParticleArrays &particles = simulation.complete_step();
    for (std::size_t k = 0; k < particles.n_owned; ++k) {
      const auto &at = particles.position[k];
      const double r = particles.radius(k);
      // Beside the bed, not on the rim.
      if (width == 0. || at.y > 0.)
        continue;
      const double middle = 0.5 * (apparatus.x_plate + apparatus.x_plate_end);
      const double half = 0.5 * plate_length, away = std::abs(at.x - middle);
      if (away < half)
        seen.deepest_in_rim = std::max(seen.deepest_in_rim, (away + r - half) / r);
      else if (away < half + rim + gap)
        seen.deepest_beside = std::max(seen.deepest_beside, (half + rim - away + r) / r);
    }
  });
  for (const Measurement &m : run->measurements())
    if (m.observable == "mass")
      seen.on_plate = std::max(seen.on_plate, m.value);
  for (double *const depth : {&seen.deepest_in_rim, &seen.deepest_beside})
    MPI_Allreduce(MPI_IN_PLACE, depth, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  return seen;
}

void examine_bed()
{
  const Seen open = spread(0.), held = spread(rim);
  check("rims keep a third more powder on the plate", held.on_plate > 1.33 * open.on_plate);
  check("the bed leans against the rims", held.deepest_in_rim > 0.);
  check("and stays between them", held.deepest_in_rim < 0.2);
  check("powder in the gaps stays out of them", held.deepest_beside < 0.2);
}

} // namespace

EUNOE_MPI_TEST()
{
  examine_places();
  examine_bed();
}
