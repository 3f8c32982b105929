#include <eunoe/core/problems.h>
#include <eunoe/state/particle_arrays.h>

#include <string>

namespace eunoe {

void ParticleArrays::resize(const std::size_t owned, const std::size_t ghosts,
                            const unsigned int n_extra)
{
  // Kernels have places in bytes, in 32 bits.
  constexpr std::size_t most = (std::size_t(1) << 32) / sizeof(Quad);
  if (owned + ghosts > most)
    throw UserError("A rank has " + std::to_string(owned + ghosts) +
                    " particles with those that it sees of others, and can have " +
                    std::to_string(most) + ". Use more ranks.");
  n_owned = owned;
  n_ghosts = ghosts;
  for (auto *array : {&position, &velocity, &spin, &force, &torque})
    array->resize(size());
  id.resize(size());
  type.resize(size());
  pace.assign(size(), 1.f);
  wake_all();
  reference.resize(size());
  extra.resize(n_extra);
  for (auto &component : extra)
    component.resize(owned);
}

void ParticleArrays::leave_out(const Remaining &remaining)
{
  for (auto *array : {&position, &velocity, &spin, &force, &torque})
    remaining.keep(*array);
  remaining.keep(id);
  remaining.keep(type);
  remaining.keep(pace);
  remaining.keep(reference);
  for (auto &component : extra)
    remaining.keep(component);
  std::size_t owned = 0;
  for (std::size_t row = 0; row < n_owned; ++row)
    owned += remaining[row] != Remaining::none ? 1 : 0;
  n_owned = owned;
  n_ghosts = id.size() - owned;
  wake_all();
}

void ParticleArrays::wake_all()
{
  awake.clear();
  awake_rows.clear();
  pressed_rows.clear();
  sleepers_moved2 = TwoLargest();
}

bool ParticleArrays::have_their_weights() const
{
  bool have_all = true;
  for_each_awake([&](const std::size_t row) {
    have_all = have_all && norm_square(force[row].vec() - mass(row) * gravity) == 0. &&
               norm_square(torque[row].vec()) == 0.;
  });
  return have_all;
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
