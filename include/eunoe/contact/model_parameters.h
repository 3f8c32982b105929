#ifndef eunoe_contact_model_parameters_h
#define eunoe_contact_model_parameters_h

#include <eunoe/contact/contact_model.h>
#include <eunoe/core/parameter_section.h>

namespace eunoe {

/// When the work is shared out anew over the ranks: `subsection load balancing`.
struct LoadBalancingParameters
{
  std::string method = "none"; ///< none, once, frequent or dynamic
  unsigned int step = 100000;
  unsigned int frequency = 100000;
  unsigned int check_frequency = 10000;
  double threshold = 0.5;
  /// When the first particles are there, sharing out by their number costs little.
  static constexpr double threshold_at_start = 0.1;
  unsigned int particle_weight = 2000;
  double active_factor = 1., inactive_factor = 0.1; ///< on the weight of who is awake or sleeps
  /// Most cells are empty, and an empty one costs next to nothing.
  unsigned int cell_weight = 20;
  /// The same as an expression in x, y, z of the cell's centre (m); empty: it does not depend on
  /// the place.
  std::string cell_weight_expression, cell_weight_constants;
};

/// Who sleeps, so that contacts at rest cost nothing: `subsection adaptive sparse contacts`.
struct SparseContactParameters
{
  bool enabled = false;
  double temperature = 1e-7; ///< square of the speed below which a particle is at rest (m2/s2)
  double rest_time = 2e-3;   ///< for which a particle must have been at rest (s)
  unsigned int frequency = 50;
};

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

  LoadBalancingParameters load_balancing;
  SparseContactParameters sparse_contacts;
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
