#ifndef eunoe_forces_load_h
#define eunoe_forces_load_h

#include <eunoe/core/registry.h>
#include <eunoe/particles/particle_arrays.h>

#include <memory>

namespace eunoe {

struct PhysicalProperties;

/// A force on every particle that is not a contact: gravity, drag, charge, ...
class Load
{
public:
  virtual ~Load() = default;

  /// Adds to force and torque of the owned particles.
  /// @param time at which the forces are computed (s)
  virtual void add(ParticleArrays &particles, double time) const = 0;
};

/// Loads by name; a maker returns null where its load does not act.
using LoadRegistry = Registry<std::unique_ptr<Load>, const PhysicalProperties &>;
LoadRegistry &loads();

} // namespace eunoe

#endif
