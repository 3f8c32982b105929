#include <eunoe/core/silent_errors.h>
#include <eunoe/solids/expression_motion.h>

#include <deal.II/base/function_parser.h>
#include <deal.II/base/utilities.h>

#include <boost/algorithm/string.hpp>

#include <cstdlib>
#include <stdexcept>

namespace eunoe {

namespace {

/// Three expressions in x, y, z and t.
class Expressions
{
public:
  Expressions(const std::string &text, const std::string &constants) : parser(3, 0., 1e-9)
  {
    std::map<std::string, double> values;
    for (const std::string &definition : dealii::Utilities::split_string_list(constants, ',')) {
      const auto parts = dealii::Utilities::split_string_list(definition, '=');
      char *end = nullptr;
      if (parts.size() == 2)
        values[parts[0]] = std::strtod(parts[1].c_str(), &end);
      if (parts.size() != 2 || parts[1].empty() || *end != '\0')
        throw std::invalid_argument("'" + definition + "' is no constant 'name=value'");
    }
    values["pi"] = M_PI;
    const auto parts = dealii::Utilities::split_string_list(text, ';');
    if (parts.size() != 3)
      throw std::invalid_argument("'" + text + "' does not hold three expressions");
    bool understood = true;
    {
      const SilentErrors silence; // the sentence that is thrown here is enough
      try {
        parser.initialize("x,y,z,t", parts, values, true);
        (*this)({}, 0.);
      } catch (const std::exception &) {
        understood = false;
      }
    }
    if (!understood)
      throw std::invalid_argument("'" + text + "' is not understood");
  }

  Vec3 operator()(const Vec3 &x, double t)
  {
    parser.set_time(t);
    const dealii::Point<3> p(x.x, x.y, x.z);
    return {parser.value(p, 0), parser.value(p, 1), parser.value(p, 2)};
  }

private:
  dealii::FunctionParser<3> parser;
};

bool is_zero(const std::string &expressions)
{
  std::string text = boost::erase_all_copy(expressions, " ");
  return text == "0;0;0" || text == "0.;0.;0." || text == "0.0;0.0;0.0";
}

} // namespace

struct ExpressionMotion::Implementation
{
  Expressions velocity, angular_velocity;
  Vec3 start;
  double time_step;

  /// What has been integrated so far.
  unsigned long long step = 0;
  Vec3 centre;
  Rotation rotation;

  void restart()
  {
    step = 0;
    centre = start;
    rotation = {};
  }

  /// State after @p dt from (@p centre, @p rotation) at time @p t.
  void advance(double t, double dt, Vec3 &x, Rotation &r)
  {
    const Vec3 v1 = velocity(x, t), w1 = angular_velocity(x, t);
    const Vec3 x2 = x + 0.5 * dt * v1;
    const Vec3 v2 = velocity(x2, t + 0.5 * dt), w2 = angular_velocity(x2, t + 0.5 * dt);
    const Vec3 x3 = x + 0.5 * dt * v2;
    const Vec3 v3 = velocity(x3, t + 0.5 * dt), w3 = angular_velocity(x3, t + 0.5 * dt);
    const Vec3 x4 = x + dt * v3;
    const Vec3 v4 = velocity(x4, t + dt), w4 = angular_velocity(x4, t + dt);
    x += dt / 6. * (v1 + 2. * v2 + 2. * v3 + v4);
    // The last term is for an axis that turns (Magnus expansion of fourth order).
    r = r.then(
        Rotation::by(dt / 6. * (w1 + 2. * w2 + 2. * w3 + w4) - dt * dt / 12. * cross(w1, w4)));
  }
};

ExpressionMotion::ExpressionMotion(const Vec3 &centre, const std::string &velocity,
                                   const std::string &velocity_constants,
                                   const std::string &angular_velocity,
                                   const std::string &angular_velocity_constants,
                                   const double time_step)
    : implementation(new Implementation{Expressions(velocity, velocity_constants),
                                        Expressions(angular_velocity, angular_velocity_constants),
                                        centre,
                                        time_step,
                                        0,
                                        centre,
                                        {}}),
      has_rotation(!is_zero(angular_velocity))
{
}

ExpressionMotion::~ExpressionMotion() = default;

RigidState ExpressionMotion::at(const double time) const
{
  Implementation &impl = *implementation;
  const double dt = impl.time_step;
  // The largest number of whole steps that do not pass the time, up to round-off.
  const auto target = static_cast<unsigned long long>(std::floor(time / dt + 1e-6));
  if (target < impl.step)
    impl.restart();
  for (; impl.step < target; ++impl.step)
    impl.advance(impl.step * dt, dt, impl.centre, impl.rotation);

  RigidState state;
  state.centre = impl.centre;
  state.rotation = impl.rotation;
  const double rest = time - target * dt;
  if (rest > 1e-6 * dt)
    impl.advance(target * dt, rest, state.centre, state.rotation);
  state.velocity = impl.velocity(state.centre, time);
  state.angular_velocity = impl.angular_velocity(state.centre, time);
  return state;
}

} // namespace eunoe
