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
                  "Laws of a contact with a wall or solid, by the same names, and 'nonlinear' for "
                  "all of Hertz's without adhesion: those of the particles if these are among "
                  "them, else 'hertz_mindlin_limit_overlap'.");
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
  check.advise(wall_method == wanted, {section}, "particle wall contact force method",
               "is '" + wall_method + "' while particles use '" + method +
                   "', so that they touch walls and solids by other laws than each other.",
               "For the same laws, set it to '" + wanted + "'.");
  laws.check(check);
}

void ContactParameters::check_with(const PhysicalProperties &physics,
                                   const ParameterCheck &check) const
{
  const bool pairs = contact_models().make(method).has_adhesion,
             walls = contact_models().make(model_of_walls()).has_adhesion;
  const std::string entry = "surface energy particles", of_wall = "surface energy wall";
  const ParameterCheck::Path properties = {"lagrangian physical properties"};
  double largest = 0.;
  for (std::size_t type = 0; type < physics.types.size(); ++type) {
    const double energy = physics.types[type].material.surface_energy;
    largest = std::max(largest, energy);
    check.advise(energy <= 0. || pairs || walls,
                 {properties[0], "particle type " + std::to_string(type)}, entry,
                 "is " + format(energy) + " J/m2, and no law has adhesion: particles use '" +
                     method + "'.",
                 "Choose 'DMT' or 'hertz_JKR' as 'particle particle contact force method', or give "
                 "no surface energy.");
  }
  check.advise(largest > 0. || !pairs, {section}, "particle particle contact force method",
               "is '" + method +
                   "', and all particles have a surface energy of 0, so that nothing attracts.",
               "Set '" + entry + "'.");
  // Which surfaces there are, and so which of these materials are in use, is not known yet.
  double largest_of_walls = 0.;
  const Materials all = physics.materials();
  for (int m = physics.wall_material(); m < all.size(); ++m)
    largest_of_walls = std::max(largest_of_walls, all[m].surface_energy);
  check.advise(largest <= 0. || !walls || largest_of_walls > 0. ||
                   check.is_written(properties, of_wall),
               properties, of_wall,
               "is 0 while particles have one, so that they do not stick to walls and solids: a "
               "contact takes the geometric mean of both.",
               "Set it, to 0 if that is meant.");
}

std::string ContactParameters::model_of_walls() const
{
  if (contact_models().make(method).wall_name == wall_method)
    return method;
  return wall_method == "nonlinear" ? "hertz_mindlin_limit_overlap" : wall_method;
}

NormalLaws ContactParameters::normal_laws() const
{
  return {method == "linear", model_of_walls() == "linear"};
}

ContactModel ContactParameters::model(const Materials &materials,
                                      const double largest_diameter) const
{
  return make(method, materials, largest_diameter, false);
}

ContactModel ContactParameters::wall_model(const Materials &materials,
                                           const double largest_diameter) const
{
  return make(model_of_walls(), materials, largest_diameter, true);
}

ContactModel ContactParameters::make(const std::string &name, const Materials &materials,
                                     const double largest_diameter, const bool is_of_walls) const
{
  ContactModelNames names = contact_models().make(name).laws;
  names.rolling = rolling_method;
  return {materials, names, laws, 0.5 * largest_diameter, is_of_walls};
}

} // namespace eunoe
