#include <eunoe/core/declare.h>
#include <eunoe/core/expressions.h>
#include <eunoe/engine/load_balancing.h>

namespace eunoe {

void LoadBalancingParameters::declare(dealii::ParameterHandler &prm)
{
  declare::enter(prm, "model parameters");
  declare::enter(prm, "load balancing");
  declare::choice(prm, "load balance method", method, "none|once|frequent|dynamic",
                  "When the mesh is divided among the ranks anew. It happens at the next contact "
                  "search and never changes a result.");
  declare::count(prm, "step", step, "once: the step.");
  declare::count(prm, "frequency", frequency, "frequent: steps between balances.", 1);
  declare::not_negative(
      prm, "threshold", threshold,
      "dynamic: balance if the largest load less the smallest exceeds this share of "
      "the mean.");
  declare::count(prm, "dynamic check frequency", check_frequency,
                 "dynamic: steps between checks of the loads.", 1);
  declare::count(prm, "particle weight", particle_weight,
                 "Cost of a particle, beside that of a cell.");
  declare::count(prm, "cell weight", cell_weight, "Cost of a cell.", 1);
  declare::not_negative(prm, "active weight factor", active_factor,
                        "Factor on the weight of particles that are awake (see 'adaptive sparse "
                        "contacts').");
  declare::not_negative(prm, "inactive weight factor", inactive_factor,
                        "Factor on the weight of particles that sleep.");
  declare::enter(prm, "cell weight function");
  declare::entry(prm, "Function expression", cell_weight_expression,
                 "Cost of a cell as an expression in x, y, z, its centre (m); empty: 'cell "
                 "weight'. Below 1 counts as 1.");
  declare::entry(prm, "Function constants", cell_weight_constants,
                 "Constants of the expression, 'a=1, b=2'.");
  declare::leave(prm);
  declare::leave(prm);
  declare::leave(prm);
}

void LoadBalancingParameters::check(const ParameterCheck &check) const
{
  if (!cell_weight_expression.empty())
    try {
      Expressions(cell_weight_expression, cell_weight_constants, 1);
    } catch (const std::invalid_argument &error) {
      check.require(false, {"model parameters", "load balancing", "cell weight function"},
                    "Function expression", "is not understood: " + std::string(error.what()) + ".",
                    "Write one expression in x, y and z.");
    }
}

} // namespace eunoe
