#ifndef eunoe_observables_observable_h
#define eunoe_observables_observable_h

#include <eunoe/core/registry.h>
#include <eunoe/observables/measurement.h>

#include <memory>

namespace eunoe {

struct ObservableParameters;
class Simulation;

/// Something that is measured during a run. An observable is one file in source/observables that
/// registers itself.
class Observable
{
public:
  virtual ~Observable() = default;

  /// Whether the forces on the solids are to be summed during the coming step.
  virtual bool wants_solid_loads(unsigned long long /*step*/) const { return false; }

  /// Called after every step and once before the first. Must call Simulation::complete_step
  /// before it looks at particles.
  virtual void step(Simulation &simulation) = 0;

  /// Called once after the last step.
  virtual void finish(Simulation &) {}

  /// What was measured for comparison with data, the same on every rank, and what it is.
  virtual std::vector<Measurement> measurements() const { return {}; }
  virtual std::vector<ObservableDescription> descriptions() const { return {}; }
};

/// A maker returns null where its observable is not asked for.
using ObservableRegistry =
    Registry<std::unique_ptr<Observable>, const ObservableParameters &, Simulation &>;
ObservableRegistry &observables();

} // namespace eunoe

#endif
