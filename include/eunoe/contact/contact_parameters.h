#ifndef eunoe_contact_contact_parameters_h
#define eunoe_contact_contact_parameters_h

#include <eunoe/contact/contact_model.h>

namespace eunoe {

/// What `subsection model parameters` says of contacts: which laws act, and the laws' own entries.
class ContactParameters : public ParameterSection
{
public:
  void declare(dealii::ParameterHandler &prm) override;
  void check(const ParameterCheck &check) const override;

  /// The laws of all contacts.
  /// @param largest_diameter of the particles (m)
  ContactModel model(const Materials &materials, double largest_diameter) const;

private:
  std::string method = "hertz_mindlin_limit_overlap";
  std::string wall_method = "nonlinear";
  std::string rolling_method = "constant";
  ContactLawSections laws;
};

} // namespace eunoe

#endif
