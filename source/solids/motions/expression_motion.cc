#include <eunoe/core/declare.h>
#include <eunoe/core/expressions.h>
#include <eunoe/solids/expression_motion.h>
#include <eunoe/solids/motion_section.h>

#include <boost/algorithm/string.hpp>

namespace eunoe {

namespace {

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
    const Vec3 v1 = velocity.vector(x, t), w1 = angular_velocity.vector(x, t);
    const Vec3 x2 = x + 0.5 * dt * v1;
    const Vec3 v2 = velocity.vector(x2, t + 0.5 * dt),
               w2 = angular_velocity.vector(x2, t + 0.5 * dt);
    const Vec3 x3 = x + 0.5 * dt * v2;
    const Vec3 v3 = velocity.vector(x3, t + 0.5 * dt),
               w3 = angular_velocity.vector(x3, t + 0.5 * dt);
    const Vec3 x4 = x + dt * v3;
    const Vec3 v4 = velocity.vector(x4, t + dt), w4 = angular_velocity.vector(x4, t + dt);
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
    : implementation(
          new Implementation{Expressions(velocity, velocity_constants, 3),
                             Expressions(angular_velocity, angular_velocity_constants, 3),
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
  state.velocity = impl.velocity.vector(state.centre, time);
  state.angular_velocity = impl.angular_velocity.vector(state.centre, time);
  return state;
}

namespace {

/// A velocity of the input: `subsection translational velocity` or `angular velocity`.
struct VelocityEntries
{
  std::string expression = "0; 0; 0", constants;

  void declare(dealii::ParameterHandler &prm, const std::string &name, const std::string &what)
  {
    declare::enter(prm, name);
    declare::entry(prm, "Function expression", expression,
                   what + ": three expressions in x, y, z (the centre of rotation) and t, "
                          "separated by ';'.");
    declare::entry(prm, "Function constants", constants,
                   "Constants of the expressions, 'a=1, b=2'.");
    declare::leave(prm);
  }
};

class ExpressionSection : public MotionSection
{
public:
  void declare(dealii::ParameterHandler &prm) override
  {
    velocity.declare(prm, "translational velocity", "Velocity of the centre of rotation (m/s)");
    angular_velocity.declare(prm, "angular velocity",
                             "Angular velocity about the centre of rotation (rad/s)");
  }

  std::unique_ptr<Motion> make(const Vec3 &centre, const double time_step) const override
  {
    std::unique_ptr<Motion> motion;
    try {
      motion = std::make_unique<ExpressionMotion>(centre, velocity.expression, velocity.constants,
                                                  angular_velocity.expression,
                                                  angular_velocity.constants, time_step);
    } catch (const std::invalid_argument &error) {
      throw std::invalid_argument(std::string(error.what()) +
                                  ", in the velocity of the solid. Write three expressions in x, "
                                  "y, z and t, separated by ';'.");
    }
    const bool moves = !is_zero(velocity.expression) || !is_zero(angular_velocity.expression);
    return moves ? std::move(motion) : nullptr;
  }

private:
  VelocityEntries velocity, angular_velocity;
};

const MotionRegistry::Registration registration(solid_motions(), "expressions", [] {
  return std::make_unique<ExpressionSection>();
});

} // namespace
} // namespace eunoe
