// At which searches the load is balanced, also after a restart.

#include <eunoe/engine/load_balancer.h>

#include "../tests.h"
#include <nlohmann/json.hpp>

using namespace test;

namespace {

unsigned int n_asked = 0;

/// Steps at which the load is balanced if there is a search every ten steps.
/// @param restart step after which a new balancer continues from the saved state; 0: none
std::string steps(const LoadBalancingParameters &parameters, double imbalance,
                  unsigned long long restart = 0)
{
  n_asked = 0;
  std::string found;
  auto balancer = std::make_unique<LoadBalancer>(parameters);
  for (unsigned long long step = 10; step <= 100; step += 10) {
    const auto ask = [imbalance] {
      ++n_asked;
      return imbalance;
    };
    if (balancer->at_search(step, ask) != nullptr)
      found += " " + std::to_string(step);
    if (step == restart) {
      const std::string saved = balancer->save().dump();
      balancer = std::make_unique<LoadBalancer>(parameters);
      balancer->load(nlohmann::ordered_json::parse(saved));
    }
  }
  return found;
}

void expect(const std::string &name, const std::string &found, const std::string &expected)
{
  check(name, found == expected, "at" + found);
}

} // namespace

EUNOE_MPI_TEST()
{
  LoadBalancingParameters parameters;
  expect("never", steps(parameters, 1.), "");
  parameters.method = "once";
  parameters.step = 35;
  expect("once", steps(parameters, 1.), " 40");
  expect("once, restarted", steps(parameters, 1., 40), " 40");
  parameters.method = "frequent";
  parameters.frequency = 25;
  expect("frequent", steps(parameters, 1.), " 30 60 90");
  expect("frequent, restarted", steps(parameters, 1., 40), " 30 60 90");
  parameters.method = "dynamic";
  parameters.check_frequency = 30;
  parameters.threshold = 0.5;
  expect("dynamic", steps(parameters, 0.6), " 30 60 90");
  expect("dynamic, balanced", steps(parameters, 0.4, 40), "");
  check("asked at three of ten searches", n_asked == 3);
}
