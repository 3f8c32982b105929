// A motion given by expressions for its velocities: constant, depending on time and on position,
// turning about fixed and moving axes. Reference: the solutions of the equations of motion. The
// state at a time has the same bits whichever times were evaluated before, as a restart needs.

#include <eunoe/solids/expression_motion.h>

#include "surfaces.h"

#include <sstream>

using namespace test;

namespace {

const double dt = 1e-4;

ExpressionMotion motion(const Vec3 &centre, const std::string &velocity,
                        const std::string &angular_velocity, const std::string &constants = "",
                        double time_step = dt)
{
  return {centre, velocity, constants, angular_velocity, constants, time_step};
}

/// Position of the point of the solid that was at @p x at the start.
Vec3 point(const Motion &motion, const Vec3 &x, double time)
{
  const RigidState state = motion.at(time);
  return state.centre + state.rotation.apply(x - motion.at(0.).centre);
}

void examine_error(const std::string &velocity, const std::string &constants,
                   const std::string &sentence)
{
  std::string answer = "nothing";
  // The parser also writes messages of its own, which are not part of the answer.
  std::ostringstream aside;
  std::streambuf *const errors = std::cerr.rdbuf(aside.rdbuf());
  try {
    motion({}, velocity, "0; 0; 0", constants);
  } catch (const std::invalid_argument &error) {
    answer = error.what();
  }
  std::cerr.rdbuf(errors);
  check("'" + velocity + "' with '" + constants + "'", answer == sentence, answer);
}

bool same_bits(const RigidState &a, const RigidState &b)
{
  return a.centre == b.centre && a.velocity == b.velocity &&
         a.angular_velocity == b.angular_velocity && a.rotation.x == b.rotation.x &&
         a.rotation.y == b.rotation.y && a.rotation.z == b.rotation.z;
}

const Vec3 start = {1e-2, 2e-2, -3e-2};

/// @param when for the names of the checks
void examine_paths(const double t, const std::string &when)
{
  // The sums over 7000 steps have an error of about 1e-14.
  const RigidState constant = motion(start, "0.1; -0.2; 0.3", "0; 0; 0").at(t);
  check_close("constant velocity" + when, norm(constant.centre - start - t * Vec3{0.1, -0.2, 0.3}),
              0., 1e-13);

  const auto swing = motion(start, "a*cos(w*t); 0; 0", "0; 0; 0", "a=0.2, w = 30");
  check_close("velocity in terms of time" + when,
              swing.at(t).centre.x - start.x - 0.2 / 30. * std::sin(30. * t), 0., 1e-13);
  check_close("its velocity" + when, swing.at(t).velocity.x - 0.2 * std::cos(30. * t), 0., 1e-14);

  const auto circle = motion({0.01, 0., 0.}, "-20*y; 20*x; -z", "0; 0; 0");
  check_close("velocity in terms of the place" + when,
              norm(circle.at(t).centre - 0.01 * Vec3{std::cos(20. * t), std::sin(20. * t), 0.}), 0.,
              1e-13);
}

/// The same for solids that turn.
void examine_turns(const double t, const std::string &when)
{
  // Turning about an axis through the moving centre.
  const auto screw = motion(start, "0.05; 0; 0", "0; 0; 2*pi*3");
  const Vec3 corner = start + Vec3{2e-3, 0., 1e-3};
  const double angle = 6. * M_PI * t;
  check_close("corner of a solid that turns and moves" + when,
              norm(point(screw, corner, t) - start -
                   Vec3{0.05 * t + 2e-3 * std::cos(angle), 2e-3 * std::sin(angle), 1e-3}),
              0., 1e-14);
  const Vec3 velocity = screw.at(t).velocity_at(point(screw, corner, t));
  check_close("velocity of the corner" + when,
              norm(velocity - Vec3{0.05 - 6. * M_PI * 2e-3 * std::sin(angle),
                                   6. * M_PI * 2e-3 * std::cos(angle), 0.}),
              0., 1e-13);

  const auto spun_up = motion({}, "0; 0; 0", "0; 8*t; 0");
  check_close("corner of a solid that is spun up" + when,
              norm(point(spun_up, {1e-3, 0., 0.}, t) -
                   1e-3 * Vec3{std::cos(4. * t * t), 0., -std::sin(4. * t * t)}),
              0., 1e-15);
}

/// An axis that itself turns about z with the rate p: as seen from a frame that turns with it, the
/// solid turns about the fixed vector w(0) - p.
Rotation nodded(const double t)
{
  const double p = 5., w = 11.;
  return Rotation::by({w * t, 0., -p * t}).then(Rotation::by({0., 0., p * t}));
}

void examine_turning_axis()
{
  const double t = 0.6;
  const Rotation expected = nodded(t);
  const auto nodding = motion({}, "0; 0; 0", "w*cos(p*t); w*sin(p*t); 0", "p=5, w=11");
  check_close("a turning axis",
              norm(nodding.at(t).rotation.x - expected.x) +
                  norm(nodding.at(t).rotation.y - expected.y),
              0., 1e-11);
  const Rotation turned = nodding.at(100 * t).rotation;
  check_close("a rotation stays one",
              std::abs(norm(turned.x) - 1.) + std::abs(dot(turned.x, turned.y)) +
                  norm(cross(turned.x, turned.y) - turned.z),
              0., 1e-10);
}

void examine_order()
{
  const double t = 0.6;
  const Rotation expected = nodded(t);
  // Halving the step divides an error of fourth order by 16.
  double path_error[2], turn_error[2];
  for (int k = 0; k < 2; ++k) {
    const double step = 0.01 / (k + 1);
    const auto coarse =
        motion({0.01, 0., 0.}, "-20*y; 20*x; 0", "w*cos(p*t); w*sin(p*t); 0", "p=5, w=11", step);
    path_error[k] = norm(coarse.at(1.).centre - 0.01 * Vec3{std::cos(20.), std::sin(20.), 0.});
    turn_error[k] = norm(coarse.at(t).rotation.x - expected.x);
  }
  check_close("order of the path", std::log2(path_error[0] / path_error[1]), 4., 0.1);
  check_close("order of the turn", std::log2(turn_error[0] / turn_error[1]), 4., 0.1);
}

void examine_questions()
{
  const std::string velocity = "-20*y; 20*x + t; z*t", angular = "t; 3*x; -1";
  const auto asked_often = motion(start, velocity, angular);
  bool same = true;
  for (const double time : {0.3, 0.1, 0., 0.30004, 0.3, 0.49999, 0.5, 0.2}) {
    const auto asked_once = motion(start, velocity, angular);
    same = same && same_bits(asked_often.at(time), asked_once.at(time));
  }
  check("a function of time alone", same);
  check("turns",
        motion({}, "0;0;0", "0; 0; 1e-9").rotates() && motion({}, "0;0;0", "0; t; 0").rotates());
  check("does not turn",
        !motion({}, "1;t;0", "0; 0; 0").rotates() && !motion({}, "0;0;0", "0;0;0").rotates());
}

void examine_errors()
{
  examine_error("0; 0", "", "'0; 0' does not hold three expressions");
  examine_error("0; 0; 0; 0", "", "'0; 0; 0; 0' does not hold three expressions");
  examine_error("0; 0; 2*(", "", "'0; 0; 2*(' is not understood");
  examine_error("0; 0; a*t", "", "'0; 0; a*t' is not understood");
  examine_error("0; 0; a*t", "a", "'a' is no constant 'name=value'");
  examine_error("0; 0; a*t", "a=two", "'a=two' is no constant 'name=value'");
  examine_error("0; 0; a*t", "a=1; b=2", "'a=1; b=2' is no constant 'name=value'");
}

} // namespace

EUNOE_TEST()
{
  // On a step and between two steps.
  for (const double t : {0.7, 0.70003}) {
    const std::string when = t == 0.7 ? "" : " between steps";
    examine_paths(t, when);
    examine_turns(t, when);
  }
  examine_turning_axis();
  examine_order();
  examine_questions();
  examine_errors();
}
