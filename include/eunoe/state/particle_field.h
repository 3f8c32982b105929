#ifndef eunoe_state_particle_field_h
#define eunoe_state_particle_field_h

#include <string>
#include <vector>

namespace eunoe {

/// Doubles that somebody attaches to every particle: their name, their number, and what a new
/// particle has.
struct ParticleField
{
  std::string name;
  unsigned int n_components;
  double initial;
};

inline unsigned int n_components(const std::vector<ParticleField> &fields)
{
  unsigned int n = 0;
  for (const ParticleField &field : fields)
    n += field.n_components;
  return n;
}

} // namespace eunoe

#endif
