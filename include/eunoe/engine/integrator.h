#ifndef eunoe_engine_integrator_h
#define eunoe_engine_integrator_h

#include <eunoe/core/plugin_section.h>
#include <eunoe/core/registry.h>
#include <eunoe/state/particle_arrays.h>

#include <memory>

namespace eunoe {

/// Moves the owned particles over one time step, before and after the forces are computed.
///
/// The work after the forces may be deferred to the beginning of the next step, in the same memory
/// pass and with the same arithmetic; `complete` does it at once, for code that reads the state.
class Integrator
{
public:
  virtual ~Integrator() = default;

  /// Brings positions to the end of the step and starts the forces of the particles that are awake
  /// anew, see `ParticleArrays::start_forces`.
  /// @param dt (s)
  /// @return how far the particles that are awake have gone; `Travel::unknown` lets contacts be
  ///         searched at every step
  virtual Travel begin_step(ParticleArrays &particles, double dt) = 0;

  /// To be called when the forces at the end of the step are complete.
  virtual void end_step() {}

  /// Brings velocities to the end of the step.
  virtual void complete(ParticleArrays &particles, double dt) = 0;
};

/// What the input says of an integrator, in entries that the integrator's own file declares.
using IntegratorSection = PluginSection<Integrator>;

using IntegratorRegistry = Registry<std::unique_ptr<IntegratorSection>>;
IntegratorRegistry &integrators();

/// The entry `integration method` of `subsection model parameters`, and those of the integrators.
class IntegratorParameters : public ParameterSection
{
public:
  IntegratorParameters();

  void declare(dealii::ParameterHandler &prm) override;
  void check(const ParameterCheck &check) const override;

  std::unique_ptr<Integrator> make() const;

private:
  std::string method = "velocity_verlet";
  std::map<std::string, std::shared_ptr<IntegratorSection>> sections;
};

} // namespace eunoe

#endif
