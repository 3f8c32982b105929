#ifndef eunoe_engine_load_h
#define eunoe_engine_load_h

#include <eunoe/core/plugin_section.h>
#include <eunoe/core/registry.h>
#include <eunoe/state/particle_arrays.h>

#include <memory>

namespace eunoe {

struct PhysicalProperties;

/// A force on every particle that is neither its weight nor a contact: drag, ...
class Load
{
public:
  virtual ~Load() = default;

  /// Adds to force and torque of the owned particles that are awake.
  /// @param time at which the forces are computed (s)
  virtual void add(ParticleArrays &particles, double time) const = 0;

  /// Whether the load on particles at rest at the end of a span of time differs from that at its
  /// beginning, so that sleepers must wake.
  virtual bool changes(double /*begin*/, double /*end*/) const { return false; }
};

/// What the input file says of a load, in entries that the load's own file declares, if it has any.
using LoadSection = PluginSection<Load, const PhysicalProperties &>;

using LoadRegistry = Registry<std::unique_ptr<LoadSection>>;
LoadRegistry &loads();

} // namespace eunoe

#endif
