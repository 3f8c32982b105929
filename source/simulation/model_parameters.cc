#include <eunoe/core/declare.h>
#include <eunoe/core/expressions.h>
#include <eunoe/simulation/model_parameters.h>

namespace eunoe {

namespace {

const std::string section = "model parameters";
const std::string capillary_section = "capillary bridges";
/// Volume of a liquid bridge over that of a particle; above it, bridges of neighbours meet.
constexpr double largest_bridge_share = 0.1;

/// What the names of the input file stand for: the law between particles, the name that the same
/// laws have for contacts with walls, and the laws.
struct NamedModel
{
  std::string name, wall_name;
  ContactModelNames laws;
};

const std::vector<NamedModel> &named_models()
{
  static const std::vector<NamedModel> models = {
      {"linear", "linear", {"linear", {}, "linear_limit_overlap", "none"}},
      {"hertz", "nonlinear", {"hertz", {}, "mindlin_undamped", "none"}},
      {"hertz_mindlin_limit_overlap", "nonlinear", {"hertz", {}, "mindlin_limit_overlap", "none"}},
      {"hertz_mindlin_limit_force", "nonlinear", {"hertz", {}, "mindlin_limit_force", "none"}},
      {"hertz_JKR", "JKR", {"jkr", {}, "mindlin_limit_overlap", "none"}},
      {"JKR", "JKR", {"jkr", {}, "mindlin_limit_overlap", "none"}},
      {"DMT", "DMT", {"hertz", {"dmt"}, "mindlin_limit_overlap", "none"}}};
  return models;
}

const NamedModel &named_model(const std::string &name)
{
  for (const NamedModel &model : named_models())
    if (model.name == name)
      return model;
  throw std::invalid_argument("there is no contact model '" + name + "'");
}

std::string names_of_models()
{
  std::string names;
  for (const NamedModel &model : named_models())
    names += (names.empty() ? "" : "|") + model.name;
  return names;
}

void declare_capillary_bridges(dealii::ParameterHandler &prm, ContactLawOptions &options)
{
  prm.enter_subsection(capillary_section);
  declare::not_negative(
      prm, "surface tension", options.surface_tension,
      "Surface tension of the liquid that forms a bridge where two bodies touch and "
      "holds it until they are too far apart (N/m); 0: no bridges.");
  declare::not_negative(prm, "contact angle", options.contact_angle,
                        "Angle at which the liquid meets the bodies (degrees).");
  declare::not_negative(prm, "volume share", options.bridge_share,
                        "Volume of a bridge over that of a particle.");
  declare::not_negative(prm, "bridge volume", options.bridge_volume,
                        "Volume of every bridge (m3); 0: 'volume share' rules.");
  prm.leave_subsection();
}

} // namespace

ContactModelNames ModelParameters::laws() const
{
  ContactModelNames names = named_model(contact_method).laws;
  names.rolling = rolling_method;
  return names;
}

void ModelParameters::declare(dealii::ParameterHandler &prm)
{
  prm.enter_subsection(section);
  declare::choice(
      prm, "particle particle contact force method", contact_method, names_of_models(),
      "Laws of a contact of two particles. All but 'linear', which has springs of constant "
      "stiffness, are Hertz's elastic force with Tsuji's damping and Mindlin's tangential force "
      "with memory, which 'hertz' does not damp; 'DMT' adds cohesion with its "
      "long-range part; 'hertz_JKR' or, in short, 'JKR' has the adhesion of soft contacts, which "
      "hold until they are drawn out to a neck.");
  declare::choice(prm, "particle wall contact force method", wall_method,
                  "linear|nonlinear|DMT|JKR",
                  "Laws of a contact with a wall or solid: the same as between particles, so "
                  "'DMT' or 'JKR' where particles use it and 'nonlinear' elsewhere.");
  prm.add_parameter("dmt cut-off threshold", options.dmt_cut_off,
                    "Share of the pull-off force below which the long-range attraction is dropped.",
                    declare::Patterns::Double(1e-6, 1.));
  declare::choice(prm, "rolling resistance torque method", rolling_method,
                  "none|constant|viscous|epsd",
                  "Resistance against rolling: none, a torque of constant magnitude, one in "
                  "proportion to the speed of rolling, or the elastic-plastic spring-dashpot of Ai "
                  "et al. (2011).");
  prm.add_parameter("f coefficient", options.epsd_f,
                    "EPSD: share of the viscous torque left once the spring is fully mobilised.",
                    declare::Patterns::Double(0., 1.));
  declare::choice(prm, "epsd inertia", epsd_inertia, "contact point|centre",
                  "EPSD: point about which the moments of inertia in the damping are taken. Ai et "
                  "al. (2011) use the contact point.");
  prm.add_action("epsd inertia", [this](const std::string &value) {
    options.epsd_inertia_about_contact = value == "contact point";
  });

  declare_capillary_bridges(prm, options);
  prm.enter_subsection("electrostatic charge");
  declare::not_negative(
      prm, "cut-off share", options.charge_cut_off,
      "Gap at which the force between two charged particles has fallen to zero, over "
      "the largest radius. The larger, the longer the lists of pairs.");
  prm.leave_subsection();
  prm.leave_subsection();
}

void ModelParameters::check(const ParameterCheck &check) const
{
  const NamedModel &model = named_model(contact_method);
  check.require(wall_method == model.wall_name, {section}, "particle wall contact force method",
                "is '" + wall_method + "' while particles use '" + contact_method + "'.",
                "Walls take the laws of the particles: set it to '" + model.wall_name + "'.");
  const ParameterCheck::Path bridges = {section, capillary_section};
  check.require(options.contact_angle < 90., bridges, "contact angle",
                "is " + format(options.contact_angle) + " degrees.",
                "Give an angle below 90: a liquid that does not wet draws nothing together.");
  check.require(options.surface_tension == 0. || options.bridge_volume > 0. ||
                    options.bridge_share > 0.,
                bridges, "volume share", "is 0 while there is a surface tension.",
                "Give a share, or a 'bridge volume'.");
  check.require(options.bridge_share <= largest_bridge_share, bridges, "volume share",
                "is " + format(options.bridge_share) + ".",
                "Give at most " + format(largest_bridge_share) +
                    ": more liquid forms no single bridges.");
}

} // namespace eunoe
