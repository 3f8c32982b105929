#ifndef eunoe_particles_new_particle_h
#define eunoe_particles_new_particle_h

#include <eunoe/particles/particle_arrays.h>

namespace eunoe {

/// A particle that is about to be inserted. SI units.
struct NewParticle
{
  ParticleId id = 0;
  int type = 0;
  double radius = 0., mass = 0.;
  Vec3 position, velocity, spin;
};

/// Mass of a sphere (kg).
inline double sphere_mass(double radius, double density)
{
  return density * (4. / 3. * M_PI) * (radius * radius * radius);
}

} // namespace eunoe

#endif
