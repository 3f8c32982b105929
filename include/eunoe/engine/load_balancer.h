#ifndef eunoe_engine_load_balancer_h
#define eunoe_engine_load_balancer_h

#include <eunoe/engine/load_balancing.h>

#include <nlohmann/json_fwd.hpp>

#include <functional>

namespace eunoe {

/// Decides at which searches the mesh cells are divided anew among the ranks.
class LoadBalancer
{
public:
  explicit LoadBalancer(const LoadBalancingParameters &parameters) : parameters(parameters) {}

  /// The parameters if the search of a step divides the mesh cells anew, else null; collective.
  /// @param imbalance largest load of a rank less the smallest, over the mean; asked for only where
  ///                  it decides
  const LoadBalancingParameters *at_search(unsigned long long step,
                                           const std::function<double()> &imbalance);

  nlohmann::ordered_json save() const;
  void load(const nlohmann::ordered_json &saved);

private:
  const LoadBalancingParameters &parameters;
  bool balanced_once = false;
  unsigned long long last_look = 0; ///< step of the last balance or look at the loads
};

} // namespace eunoe

#endif
