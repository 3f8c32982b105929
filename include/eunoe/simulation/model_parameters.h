#ifndef eunoe_simulation_model_parameters_h
#define eunoe_simulation_model_parameters_h

#include <eunoe/contact/contact_model.h>
#include <eunoe/core/parameter_section.h>

namespace eunoe {

/// `subsection model parameters`.
struct ModelParameters : public ParameterSection
{
  std::string contact_method = "hertz_mindlin_limit_overlap";
  std::string wall_method = "nonlinear";
  std::string rolling_method = "constant";
  ContactLawOptions options;
  std::string epsd_inertia = "contact point";

  /// The laws behind the names of the input file.
  ContactModelNames laws() const;

  void declare(dealii::ParameterHandler &prm) override;
  void check(const ParameterCheck &check) const override;
};

} // namespace eunoe

#endif
