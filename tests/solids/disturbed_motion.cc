// Vibrations and excursions on top of another motion: positions in closed form, and velocities that
// are the derivatives of the positions.

#include <eunoe/solids/disturbed_motion.h>
#include <eunoe/solids/scheduled_motion.h>

#include "tests.h"

using namespace test;

namespace {

void examine_velocity(const std::string &name, const Motion &motion, double t)
{
  const double h = 1e-7;
  const Vec3 difference = (motion.at(t + h).centre - motion.at(t - h).centre) / (2. * h);
  const Vec3 velocity = motion.at(t).velocity;
  check_close("velocity of " + name, norm(velocity - difference), 0., 1e-6);
}

} // namespace

EUNOE_TEST()
{
  auto pass = std::make_shared<PassMotion>(Vec3{0., 1e-3, 0.}, Vec3{0.1, 0., 0.}, 1.);
  pass->add(0.5);
  const double f = 40., a = 20e-6;
  const VibratingMotion vibrating(pass, {0., a, 0.}, f);
  for (const double t : {0.0125, 0.51, 0.75}) {
    const RigidState state = vibrating.at(t);
    check_close("vibration", state.centre.y, 1e-3 + a * std::sin(2. * M_PI * f * t), 1e-18);
    check_close("pass below the vibration", state.centre.x, pass->at(t).centre.x, 0.);
    examine_velocity("the vibration", vibrating, t);
  }
  check_close("crest", vibrating.at(0.25 / f).centre.y - 1e-3, a, 1e-18);

  auto plate = std::make_shared<StrokeMotion>(Vec3());
  plate->add(2., 1., {0., -1e-4, 0.});
  const double depth = 30e-6;
  YieldingMotion yielding(plate, {0., -depth, 0.});
  yielding.add(0.2, 0.4);
  yielding.add(1.0, 0.2);
  check_close("yields most in the middle", yielding.at(0.4).centre.y, -depth, 1e-18);
  check_close("yields again", yielding.at(1.1).centre.y, -depth, 1e-18);
  check_close("half of the way", yielding.at(0.3).centre.y, -0.5 * depth, 1e-18);
  for (const double t : {0., 0.2, 0.6, 0.8, 1., 1.2, 2.})
    check("at rest before and after",
          norm(yielding.at(t).centre) < 1e-18 && norm(yielding.at(t).velocity) < 1e-15);
  for (const double t : {0.25, 0.4, 0.55, 1.15, 2.4})
    examine_velocity("the yielding plate", yielding, t);
  check_close("stroke after all", yielding.at(4.).centre.y, -1e-4, 0.);
}
