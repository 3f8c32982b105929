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
  std::string integration_method = "velocity_verlet";

  std::string detection_method = "dynamic";
  unsigned int detection_frequency = 1;
  double displacement_share = 0.8;     ///< "dynamic contact search size coefficient"
  double neighborhood_threshold = 1.3; ///< reach of the search over the largest diameter

  std::string lost_particles = "stop"; ///< stop, remove or ignore
  double largest_overlap = 0.5;        ///< over the radius of the smaller particle; 0: any

  /// Steps after which all contacts lose their memory; 0: never. For studies of forgetting.
  unsigned long long forget_interval = 0;
  bool forgets_at(unsigned long long step) const
  {
    return forget_interval > 0 && step % forget_interval == 0;
  }

  /// The laws behind the names of the input file.
  ContactModelNames laws() const;

  /// Gap up to which the search lists pairs (m), for particles of at most @p largest_diameter.
  double skin(double largest_diameter) const
  {
    return (neighborhood_threshold - 1.) * largest_diameter;
  }

  void declare(dealii::ParameterHandler &prm) override;
  void check(const ParameterCheck &check) const override;
};

} // namespace eunoe

#endif
