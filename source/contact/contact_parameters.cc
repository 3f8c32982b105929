#include <eunoe/contact/contact_parameters.h>
#include <eunoe/core/declare.h>

#include <set>

namespace eunoe {

namespace {

const std::string section = "model parameters";

/// The names that models have for contacts with walls, as "a|b|c".
std::string names_for_walls()
{
  std::set<std::string> names;
  for (const auto &[name, model] : contact_models().make_all())
    names.insert(model.wall_name);
  std::string all;
  for (const std::string &name : names)
    all += (all.empty() ? "" : "|") + name;
  return all;
}

} // namespace

void ContactParameters::declare(dealii::ParameterHandler &prm)
{
  declare::enter(prm, section);
  declare::choice(prm, "particle particle contact force method", method, contact_models().names(),
                  "Laws of a contact of two particles. All but 'linear', which has springs of "
                  "constant stiffness, are Hertz's elastic force with Tsuji's damping and "
                  "Mindlin's tangential force with memory, which 'hertz' does not damp; 'DMT' "
                  "adds cohesion with its long-range part; 'hertz_JKR' or, in short, 'JKR' has "
                  "the adhesion of soft bodies, whose contact forms a neck and holds across a "
                  "small separation.");
  declare::choice(prm, "particle wall contact force method", wall_method, names_for_walls(),
                  "Laws of a contact with a wall or solid: the same as between particles, so "
                  "'DMT' or 'JKR' where particles use it and 'nonlinear' elsewhere.");
  declare::choice(prm, "rolling resistance torque method", rolling_method,
                  "none|" + contact_laws("rolling").names(),
                  "Resistance against rolling: none, a torque of constant magnitude, one in "
                  "proportion to the speed of rolling, or the elastic-plastic spring-dashpot of Ai "
                  "et al. (2011).");
  declare::leave(prm);
  laws.declare(prm);
}

void ContactParameters::check(const ParameterCheck &check) const
{
  const std::string wanted = contact_models().make(method).wall_name;
  check.require(wall_method == wanted, {section}, "particle wall contact force method",
                "is '" + wall_method + "' while particles use '" + method + "'.",
                "Walls take the laws of the particles: set it to '" + wanted + "'.");
  laws.check(check);
}

ContactModel ContactParameters::model(const Materials &materials,
                                      const double largest_diameter) const
{
  ContactModelNames names = contact_models().make(method).laws;
  names.rolling = rolling_method;
  return {materials, names, laws, 0.5 * largest_diameter};
}

} // namespace eunoe
