#include <eunoe/particles/particle_arrays.h>

namespace eunoe {

void ParticleArrays::resize(const std::size_t owned, const std::size_t ghosts,
                            const unsigned int n_extra)
{
  n_owned = owned;
  n_ghosts = ghosts;
  for (auto *array : {&position, &velocity, &spin, &force, &torque})
    array->resize(size());
  id.resize(size());
  type.resize(size());
  reference.resize(owned);
  extra.resize(n_extra);
  for (auto &component : extra)
    component.resize(owned);
}

} // namespace eunoe
