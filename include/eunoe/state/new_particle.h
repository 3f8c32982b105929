#ifndef eunoe_state_new_particle_h
#define eunoe_state_new_particle_h

#include <eunoe/state/particle_arrays.h>

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

/// Whether a double, as from a file, is one of the whole numbers 0, 1, ..., @p n - 1.
inline bool is_number_below(double value, double n)
{
  return value >= 0. && value < n && value == std::floor(value);
}

/// Whether numbers from a file are an id, a type of @p n_types, a radius and a mass (SI units).
inline bool are_of_particle(const double *id_type_radius_mass, double n_types)
{
  const auto &v = id_type_radius_mass;
  return is_number_below(v[0], 0x1p32) && is_number_below(v[1], n_types) && v[2] > 0. &&
         v[3] > 0. && std::isfinite(v[2]) && std::isfinite(v[3]);
}

} // namespace eunoe

#endif
