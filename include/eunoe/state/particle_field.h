#ifndef eunoe_state_particle_field_h
#define eunoe_state_particle_field_h

#include <string>
#include <vector>

namespace eunoe {

/// Doubles that a part of the program attaches to every particle: their name, number, and value
/// for a new particle.
struct ParticleField
{
  std::string name;
  unsigned int n_components;
  double initial;
};

/// Where the doubles of a field are among all extra doubles of a particle. Comes from
/// `ParticleFields::add`.
struct FieldHandle
{
  unsigned int first;
};

/// The fields of all particles of a run, in the order in which they were added.
class ParticleFields
{
public:
  FieldHandle add(const ParticleField &field)
  {
    const FieldHandle handle = {n_components()};
    fields.push_back(field);
    return handle;
  }

  const std::vector<ParticleField> &list() const { return fields; }

  /// Number of extra doubles of a particle.
  unsigned int n_components() const
  {
    unsigned int n = 0;
    for (const ParticleField &field : fields)
      n += field.n_components;
    return n;
  }

  /// The extra doubles of a new particle.
  std::vector<double> initial_values() const
  {
    std::vector<double> values;
    for (const ParticleField &field : fields)
      values.insert(values.end(), field.n_components, field.initial);
    return values;
  }

private:
  std::vector<ParticleField> fields;
};

} // namespace eunoe

#endif
