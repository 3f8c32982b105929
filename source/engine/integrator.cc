#include <eunoe/core/declare.h>
#include <eunoe/engine/integrator.h>

namespace eunoe {

IntegratorRegistry &integrators()
{
  static IntegratorRegistry registry("integration method");
  return registry;
}

IntegratorParameters::IntegratorParameters() : sections(integrators().make_all()) {}

void IntegratorParameters::declare(dealii::ParameterHandler &prm)
{
  declare::enter(prm, "model parameters");
  declare::choice(prm, "integration method", method, integrators().names(), "Time integration.");
  declare::leave(prm);
  for (auto &[name, section] : sections)
    section->declare(prm);
}

void IntegratorParameters::check(const ParameterCheck &check) const
{
  sections.at(method)->check(check);
}

std::unique_ptr<Integrator> IntegratorParameters::make() const
{
  return sections.at(method)->make();
}

} // namespace eunoe
