// A spreading apparatus with imperfections: where its surfaces are, how they move, and a run with
// all imperfections at once.

#include <eunoe/processes/powder_spreading/apparatus.h>

#include "small_case.h"
#include "tests.h"

using namespace test;
using spreading::Apparatus;
using spreading::SpreadingParameters;

namespace {

SpreadingParameters small_apparatus()
{
  SpreadingParameters p;
  p.length_factor = 0.02;
  p.depth = slice_depth;
  p.spreader_radius = 0.3e-3;
  return p;
}

/// The first spreader before its first pass.
Solid spreader_of(const SpreadingParameters &p)
{
  std::vector<Solid> solids;
  const auto handles = Apparatus(p, 100e-6).add_solids(solids, 1);
  return solids[handles.spreaders[0].number];
}

/// Height of the spreader's lowest point at a position z, from its edges that cross it (m).
double clearance_at(const SpreadingParameters &p, const double z)
{
  const Solid spreader = spreader_of(p);
  const std::vector<Vec3> corners = spreader.shape->triangles();
  double lowest = 1.;
  for (std::size_t t = 0; t < corners.size(); t += 3)
    for (unsigned int e = 0; e < 3; ++e) {
      const Vec3 &a = corners[t + e], &b = corners[t + (e + 1) % 3];
      if (a.z != b.z && (a.z - z) * (b.z - z) <= 0.)
        lowest = std::min(lowest, a.y + (b.y - a.y) * (z - a.z) / (b.z - a.z));
    }
  return lowest + spreader.motion->at(0.).centre.y;
}

void examine_clearance()
{
  constexpr double tolerance = 1e-12, tilt = 40e-6, d = slice_depth;
  SpreadingParameters p = small_apparatus();
  check_close("clearance", clearance_at(p, 0.1e-3), 100e-6, tolerance);
  p.clearance_offset = -30e-6;
  check_close("offset", clearance_at(p, 0.1e-3), 70e-6, tolerance);
  for (const char *const shape : {"half round", "flat blade"}) {
    const std::string name = std::string(", ") + shape;
    p.spreader = shape;
    p.spreader_tilt = tilt;
    p.side_walls = false;
    check_close("tilt, begin of the period" + name, clearance_at(p, 0.), 90e-6, tolerance);
    check_close("tilt, a quarter" + name, clearance_at(p, 0.25 * d), 70e-6, tolerance);
    check_close("tilt, middle" + name, clearance_at(p, 0.5 * d), 50e-6, tolerance);
    check_close("tilt, an eighth" + name, clearance_at(p, 0.125 * d), 80e-6, tolerance);
    for (const double z : {-0.2e-3, -0.05e-3, 0.03e-3, 0.15e-3})
      check_close("tilt, one period on" + name, clearance_at(p, z), clearance_at(p, z + d),
                  tolerance);
    p.side_walls = true;
    check_close("tilt, first wall" + name, clearance_at(p, 0.), 50e-6, tolerance);
    check_close("tilt, middle between walls" + name, clearance_at(p, 0.5 * d), 70e-6, tolerance);
    check_close("tilt, second wall" + name, clearance_at(p, d), 90e-6, tolerance);
  }
}

void examine_vibration()
{
  SpreadingParameters p = small_apparatus();
  p.vibration_amplitude = 10e-6;
  p.vibration_frequency = 250.;
  const Solid spreader = spreader_of(p);
  check_close("crest of the vibration", spreader.motion->at(1e-3).centre.y, 110e-6, 1e-15);
  check_close("trough of the vibration", spreader.motion->at(3e-3).centre.y, 90e-6, 1e-15);
  check_close("its speed", spreader.motion->at(2e-3).velocity.y, -p.vibration_speed(), 1e-12);
}

/// Extreme positions of plate, platform, spreader and powder in a run of two layers.
struct Seen
{
  double lowest_plate = 0., final_plate = 0., highest_platform = -1.;
  double lowest_spreader = 1., highest_spreader = 0.;
  double deepest_in_wall = 0.; ///< over the radius
};

Seen look_at(Case &run, const MPI_Comm comm)
{
  Seen seen;
  run.run([&seen](Simulation &simulation) {
    for (const Solid &solid : simulation.get_solids()) {
      const double y = solid.state.centre.y;
      if (solid.name == "measuring plate") {
        seen.lowest_plate = std::min(seen.lowest_plate, y);
        seen.final_plate = y;
      } else if (solid.name == "feedstock platform")
        seen.highest_platform = std::max(seen.highest_platform, y);
      else if (solid.name == "spreader 0") {
        seen.lowest_spreader = std::min(seen.lowest_spreader, y);
        seen.highest_spreader = std::max(seen.highest_spreader, y);
      }
    }
    const ParticleArrays &p = simulation.complete_step();
    for (std::size_t k = 0; k < p.n_owned; ++k) {
      const double z = p.position[k].z, r = p.radius(k);
      seen.deepest_in_wall =
          std::max({seen.deepest_in_wall, (r - z) / r, (z + r - slice_depth) / r});
    }
  });
  MPI_Allreduce(MPI_IN_PLACE, &seen.deepest_in_wall, 1, MPI_DOUBLE, MPI_MAX, comm);
  return seen;
}

double find(const std::vector<Measurement> &all, const std::string &observable, int index)
{
  for (const Measurement &m : all)
    if (m.observable == observable && m.index == index)
      return m.value;
  return std::numeric_limits<double>::quiet_NaN();
}

void examine_run()
{
  constexpr double recoil = 20e-6, plate_error = 0.2, feed_error = -0.1;
  Case run(small_spreading("results", R"(
  set spreader clearance offset    = 10e-6
  set spreader tilt                = 30e-6
  set spreader vibration amplitude = 5e-6
  set spreader vibration frequency = 400
  set layer thickness error        = 0.2
  set feedstock stroke error       = -0.1
  set plate recoil                 = 20e-6
  set side walls                   = true)"));
  const Seen seen = look_at(run, MPI_COMM_WORLD);
  const double stroke = layer_thickness * (1. + plate_error);
  check_close("stroke of the plate", seen.final_plate, -stroke, 1e-12);
  check_relative("recoil of the plate", seen.lowest_plate, -stroke - recoil, 1e-4);
  // The bed of the second pass is one stroke and the margin deep, whatever the error.
  check_relative("stroke of the platform", seen.highest_platform,
                 -(later_stroke + margin) + later_stroke * (1. + feed_error), 1e-9);
  check_relative("spreader at its lowest", seen.lowest_spreader, clearance + 10e-6 - 5e-6, 1e-4);
  check_relative("spreader at its highest", seen.highest_spreader, clearance + 10e-6 + 5e-6, 1e-4);
  check("powder stays between the side walls", seen.deepest_in_wall < 0.1);
  check("powder touches the side walls", seen.deepest_in_wall > 0.);
  const auto all = run->measurements();
  const double full = density * plate_length * slice_depth * layer_thickness;
  check_relative("LRD counts the nominal layer", find(all, "LRD", 1),
                 (find(all, "mass", 1) - find(all, "mass", 0)) / full, 1e-12);
}

} // namespace

EUNOE_MPI_TEST()
{
  examine_clearance();
  examine_vibration();
  examine_run();
}
