#ifndef eunoe_contact_contact_parameters_h
#define eunoe_contact_contact_parameters_h

#include <eunoe/contact/contact_model.h>
#include <eunoe/state/physical_properties.h>

namespace eunoe {

/// What `subsection model parameters` says of contacts: which laws act, and the laws' own entries.
class ContactParameters : public ParameterSection
{
public:
  void declare(dealii::ParameterHandler &prm) override;
  void check(const ParameterCheck &check) const override;
  /// Whether adhesion that the materials ask for is in the laws, and the reverse.
  void check_with(const PhysicalProperties &physics, const ParameterCheck &check) const;

  NormalLaws normal_laws() const;

  /// The laws of two particles.
  /// @param largest_diameter of the particles (m)
  ContactModel model(const Materials &materials, double largest_diameter) const;
  /// The laws of a particle and a wall or solid.
  ContactModel wall_model(const Materials &materials, double largest_diameter) const;

private:
  /// Name of the model that walls take: that of the particles where it has a name for walls.
  std::string model_of_walls() const;
  ContactModel make(const std::string &name, const Materials &materials, double largest_diameter,
                    bool is_of_walls) const;

  std::string method = "hertz_mindlin_limit_overlap";
  std::string wall_method = "nonlinear";
  std::string rolling_method = "constant";
  ContactLawSections laws;
};

} // namespace eunoe

#endif
