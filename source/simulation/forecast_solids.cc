// The solids of the input before the run: where they are, how large, where they go, how fast.

#include "judgements.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace eunoe {

namespace {

/// Instants at which a prescribed motion is looked at.
constexpr unsigned int n_looks = 500;
/// Largest and smallest length of a solid over that of the mesh.
constexpr double largest_ratio = 100., smallest_ratio = 1e-3;

const std::string mend_scale =
    "All lengths are in metres: 'scale = 0.001' takes a file in millimetres.";

std::vector<Vec3> corners_at(const Box &own, const RigidState &state)
{
  std::vector<Vec3> corners;
  for (unsigned int corner = 0; corner < 8; ++corner)
    corners.push_back(state.centre +
                      state.rotation.apply({corner & 1 ? own.upper.x : own.lower.x,
                                            corner & 2 ? own.upper.y : own.lower.y,
                                            corner & 4 ? own.upper.z : own.lower.z}));
  return corners;
}

Box box_at(const Box &own, const RigidState &state)
{
  return Box::around(corners_at(own, state));
}

bool overlap(const Box &a, const Box &b)
{
  bool result = true;
  for (unsigned int d = 0; d < 3; ++d)
    result = result && a.lower[d] <= b.upper[d] && a.upper[d] >= b.lower[d];
  return result;
}

double longest_edge(const Box &box)
{
  const Vec3 size = box.upper - box.lower;
  return std::max({size.x, size.y, size.z});
}

/// What a solid does in a run.
struct Path
{
  bool meets_mesh = false;
  double largest_speed = 0., when = 0.; ///< of a corner of its box (m/s, s)
  std::optional<double> ends;           ///< when its motion is no number any more (s)
  /// A direction with a period, near an end of which the solid ends, and when (s).
  std::optional<std::pair<unsigned int, double>> open_end;
};

/// A direction with a period in which a box ends nearer than @p reach to an end of the period,
/// inside or outside, so that a particle there meets its edge, or what its image should meet is
/// missing.
std::optional<unsigned int> open_end(const Box &box, const PeriodicBox &periods, const double reach)
{
  for (unsigned int d = 0; d < 3; ++d) {
    const double lower = periods.origin[d], upper = lower + periods.length[d];
    const bool apart = box.upper[d] < lower - reach || box.lower[d] > upper + reach,
               inside = box.lower[d] > lower + reach && box.upper[d] < upper - reach,
               through = box.lower[d] < lower - reach && box.upper[d] > upper + reach;
    if (periods.is_periodic(d) && !apart && !inside && !through)
      return d;
  }
  return std::nullopt;
}

/// The box around the mesh, which may move.
struct MeshPath
{
  Box from_centre;
  std::shared_ptr<const Motion> motion; ///< null: at rest

  Box at(const double time) const
  {
    const Vec3 centre = motion ? motion->at(time).centre : Vec3();
    return {from_centre.lower + centre, from_centre.upper + centre};
  }
};

/// When a motion is looked at, in parts of the interval between looks: not evenly, as a vibration
/// may have a period of so many intervals.
double look(const unsigned int k)
{
  constexpr double golden = 0.6180339887498949;
  const double share = k == 0 || k == n_looks ? 0. : golden * k - std::floor(golden * k);
  return k + 0.5 * share;
}

/// Follows the prescribed motion in few large steps.
/// @param reach of particles (m)
Path follow(const SolidObject &object, const Box &own, const MeshPath &mesh,
            const PeriodicBox &periods, const double reach, const double duration)
{
  const double interval = std::max(duration, 1e-12) / n_looks;
  const std::shared_ptr<const Motion> motion = object.make_motion(interval);
  Path path;
  for (unsigned int k = 0; k <= n_looks; ++k) {
    const double time = look(k) * interval;
    const RigidState state = motion->at(time);
    const Box box = box_at(own, state);
    path.meets_mesh = path.meets_mesh || overlap(box, mesh.at(time));
    if (const auto direction = open_end(box, periods, reach); direction && !path.open_end)
      path.open_end = {*direction, time};
    for (const Vec3 &corner : corners_at(own, state)) {
      const double speed = norm(state.velocity_at(corner));
      if (!path.ends && !std::isfinite(speed + norm(corner)))
        path.ends = time;
      if (speed > path.largest_speed) {
        path.largest_speed = speed;
        path.when = time;
      }
    }
  }
  return path;
}

/// @return whether the solid's size is plausible
bool judge_size(const std::string &where, const Box &box, const Box &space, Problems &problems)
{
  const double ratio = longest_edge(box) / longest_edge(space);
  if (ratio > largest_ratio)
    problems.warn(where,
                  "the solid is " + format(longest_edge(box)) + " m long, " + format(ratio) +
                      " times as long as the mesh.",
                  mend_scale);
  else if (ratio < smallest_ratio)
    problems.warn(
        where,
        "the solid is only " + format(longest_edge(box)) + " m long, while the mesh is " +
            format(longest_edge(space)) + " m long.",
        "All lengths are in metres; correct its 'scale' or its coordinates, or the mesh.");
  return ratio <= largest_ratio && ratio >= smallest_ratio;
}

} // namespace

double judge_solids(const Parameters &parameters, const std::vector<Solid> &solids,
                    const Domain &domain, const DiameterRange &diameters, Forecast &forecast)
{
  const double smallest_radius = 0.5 * diameters.smallest;
  double fastest = 0.;
  const MeshPath mesh = {domain.box_from_centre(), parameters.grid_motion.make()};
  const Box space = mesh.at(0.);
  const double dt = parameters.control.time_step;
  const double duration = dt * static_cast<double>(parameters.control.n_steps());
  for (const Solid &solid : solids) {
    if (!solid.object)
      continue;
    const Box own = solid.shape->bounding_box();
    const Box box = box_at(own, solid.motion->at(0.));
    forecast.facts.push_back("Solid object " + std::to_string(*solid.object) + ": " +
                             describe(box));
    const std::string where =
        "subsection 'solid objects' / subsection 'solid surfaces' / subsection '" + solid.name +
        "':";
    const bool fits = judge_size(where, box, space, forecast.problems);
    const Path path = follow(parameters.solids.objects[*solid.object], own, mesh, domain.periods(),
                             diameters.largest, duration);
    if (path.ends)
      forecast.problems.add(where,
                            "from t = " + format(*path.ends) +
                                " s on its velocity or place is no finite number.",
                            "Correct its 'translational velocity' or 'angular velocity', so that "
                            "they are numbers until the end of the run.");
    if (!path.meets_mesh)
      forecast.problems.warn(where,
                             "the solid lies outside the mesh during the whole run: at the "
                             "beginning from " +
                                 describe(box) + ", while the mesh goes from " + describe(space) +
                                 ".",
                             "Correct its 'scale' (0.001 for a file in millimetres), its 'initial "
                             "translation' or its velocity, or enlarge the mesh.");
    if (path.meets_mesh && path.open_end && diameters.largest > 0.)
      forecast.problems.warn(
          where,
          "at t = " + format(path.open_end->second) + " s it ends near a periodic end in " +
              "xyz"[path.open_end->first] +
              ". Solids have no periodic images: a grain that crosses that end meets the solid's "
              "edge, or nothing.",
          "Let it reach the largest diameter, " + format(diameters.largest) +
              " m, beyond both ends, or stay as far away from them.");
    judge_jump(path.largest_speed, parameters, smallest_radius,
               " at t = " + format(path.when) + " s", fits ? "" : mend_scale, forecast.problems);
    fastest = std::max(fastest, path.largest_speed);
  }
  return fastest;
}

} // namespace eunoe
