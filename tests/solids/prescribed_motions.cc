// The motions that a process prescribes: strokes with a velocity that is a parabola in time, passes
// at constant velocity, jumps, and a surface that moves in place. Reference: their formulas, and
// the velocity as the derivative of the path.

#include <eunoe/solids/scheduled_motion.h>

#include "surfaces.h"

using namespace test;

namespace {

/// Largest difference between the velocity and the slope of the path away from @p kinks, and
/// largest step of the path (m).
struct Path
{
  double worst_velocity = 0., largest_step = 0.;

  Path(const Motion &motion, double end, const std::vector<double> &kinks)
  {
    const double h = 1e-5;
    Vec3 last = motion.at(0.).centre;
    for (int k = 1; k * h < end; ++k) {
      const double t = k * h;
      const RigidState state = motion.at(t);
      largest_step = std::max(largest_step, norm(state.centre - last));
      last = state.centre;
      if (std::any_of(kinks.begin(), kinks.end(),
                      [&](double kink) { return std::abs(t - kink) < 1.5 * h; }))
        continue;
      const Vec3 slope = (motion.at(t + h).centre - motion.at(t - h).centre) / (2. * h);
      worst_velocity = std::max(worst_velocity, norm(state.velocity - slope));
    }
  }
};

} // namespace

EUNOE_TEST()
{
  const Vec3 start = {1e-3, 2e-3, 3e-3}, up = {0., 2e-3, 0.}, aside = {-1e-3, 0., 4e-3};

  StrokeMotion strokes(start);
  strokes.add(0.1, 0.2, up);
  strokes.add(0.3, 0.1, aside);
  strokes.add(0.6, 0., -up);
  const auto centre = [&](double t) { return strokes.at(t).centre; };
  const auto speed = [&](double t) { return norm(strokes.at(t).velocity); };
  check("at the start before the first stroke", centre(0.) == start && centre(0.0999) == start);
  check_close("half way at half time", norm(centre(0.2) - (start + 0.5 * up)), 0., 1e-17);
  check_close("at the end after a stroke", norm(centre(0.3) - (start + up)), 0., 1e-17);
  check_close("strokes add up", norm(centre(0.5) - (start + up + aside)), 0., 1e-17);
  check("at rest before, between and after",
        speed(0.05) == 0. && speed(0.5) == 0. && speed(0.7) == 0.);
  check_close("starts and ends at rest", speed(0.1) + speed(0.3) + speed(0.4), 0., 1e-15);
  check_relative("largest velocity is 3/2 of the mean", speed(0.2), 1.5 * norm(up) / 0.2, 1e-14);
  check_relative("parabola", speed(0.15), 0.75 * 1.5 * norm(up) / 0.2, 1e-14);
  check_close("no jump before its time", norm(centre(0.6 - 1e-9) - (start + up + aside)), 0.,
              1e-17);
  check_close("a jump at its time", norm(centre(0.6) - (start + aside)), 0., 1e-17);
  check("a jump has no velocity", speed(0.6) == 0.);
  // Differences of a cubic path are off by h^2 / 6 of its third derivative, 1e-9 m/s.
  const Path path(strokes, 0.59, {0.1, 0.3, 0.4});
  check_close("velocity of strokes is the slope of the path", path.worst_velocity, 0., 1e-8);
  check_close("strokes have no jumps", path.largest_step, 0., 1.51 * norm(aside) / 0.1 * 1e-5);

  PassMotion passes(start, {0.25, 0., 0.}, 0.2);
  passes.add(0.1);
  passes.add(0.4);
  const Vec3 end = start + Vec3{0.05, 0., 0.};
  const auto place = [&](double t) { return passes.at(t).centre; };
  check("waits at the start", place(0.) == start && passes.at(0.0999).velocity == Vec3());
  check_close("half way of a pass", norm(place(0.2) - 0.5 * (start + end)), 0., 1e-17);
  check("velocity of a pass", passes.at(0.1).velocity == Vec3({0.25, 0., 0.}) &&
                                  passes.at(0.2999).velocity == Vec3({0.25, 0., 0.}));
  check_close("stays at the end", norm(place(0.31) - end) + norm(place(0.3999) - end), 0., 1e-17);
  check("at rest at the end", passes.at(0.31).velocity == Vec3());
  check_close("the next pass begins where the first did", norm(place(0.4) - start), 0., 1e-17);
  check_close("half way of the second", norm(place(0.5) - 0.5 * (start + end)), 0., 1e-16);
  check_close("at the end for good", norm(place(9.) - end), 0., 1e-17);
  check_close("velocity of passes is the slope of the path",
              Path(passes, 0.7, {0.1, 0.3, 0.4, 0.6}).worst_velocity, 0., 1e-9);

  const AtRest belt(start, {0.1, 0., 0.}, {0., 2., 0.});
  check("a belt stays where it is", belt.at(0.).centre == start && belt.at(5.).centre == start);
  check("a belt does not turn", !belt.rotates() && belt.at(5.).rotation.x == Vec3({1., 0., 0.}));
  check_close("velocity of its surface",
              norm(belt.at(1.).velocity_at(start + Vec3{1., 0., 0.}) - Vec3{0.1, 0., -2.}), 0.,
              1e-15);
}
