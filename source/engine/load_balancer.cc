#include <eunoe/checkpoint/head_values.h>
#include <eunoe/engine/load_balancer.h>

namespace eunoe {

const LoadBalancingParameters *LoadBalancer::at_search(const unsigned long long step,
                                                       const std::function<double()> &imbalance)
{
  const LoadBalancingParameters &p = parameters;
  bool due = false;
  if (p.method == "once")
    due = !balanced_once && step >= p.step;
  else if (p.method == "frequent")
    due = step >= last_look + p.frequency;
  else if (p.method == "dynamic" && step >= last_look + p.check_frequency) {
    last_look = step;
    due = imbalance() > p.threshold;
  }
  if (!due)
    return nullptr;
  balanced_once = true;
  last_look = step;
  return &p;
}

nlohmann::ordered_json LoadBalancer::save() const
{
  return {{"balanced_once", balanced_once}, {"last_look", last_look}};
}

void LoadBalancer::load(const nlohmann::ordered_json &saved)
{
  balanced_once = saved.at("balanced_once").get<bool>();
  last_look = count_in(saved.at("last_look"));
}

} // namespace eunoe
