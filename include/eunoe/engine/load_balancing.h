#ifndef eunoe_engine_load_balancing_h
#define eunoe_engine_load_balancing_h

#include <eunoe/core/parameter_section.h>

namespace eunoe {

/// When the work is divided anew among the ranks: `subsection load balancing`.
struct LoadBalancingParameters : public ParameterSection
{
  std::string method = "none"; ///< none, once, frequent or dynamic
  unsigned int step = 100000;
  unsigned int frequency = 100000;
  unsigned int check_frequency = 10000;
  double threshold = 0.5;
  /// When the first particles are there, balancing by their number costs little.
  static constexpr double threshold_at_start = 0.1;
  unsigned int particle_weight = 2000;
  double active_factor = 1.,
         inactive_factor = 0.1; ///< on the weights of awake particles and of sleepers
  /// Most mesh cells are empty, and an empty one costs next to nothing.
  unsigned int cell_weight = 20;
  /// The same as an expression in x, y, z of the cell's centre (m); empty: it does not depend on
  /// the place.
  std::string cell_weight_expression, cell_weight_constants;

  void declare(dealii::ParameterHandler &prm) override;
  void check(const ParameterCheck &check) const override;
};

} // namespace eunoe

#endif
