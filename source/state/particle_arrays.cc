#include <eunoe/state/particle_arrays.h>

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
  pace.assign(size(), 1.f);
  wake_all();
  reference.resize(owned);
  extra.resize(n_extra);
  for (auto &component : extra)
    component.resize(owned);
}

void ParticleArrays::wake_all()
{
  awake.clear();
  awake_rows.clear();
  pressed_rows.clear();
  sleepers_moved2 = 0.;
}

void ParticleArrays::clear_forces_on_sleepers()
{
  for (std::size_t row = 0; row < n_owned; ++row)
    if (awake[row] == 0)
      force[row] = torque[row] = Quad();
}

void ParticleArrays::clear_forces_on_pressed()
{
  for (const std::int32_t row : pressed_rows)
    force[row] = torque[row] = Quad();
}

} // namespace eunoe
