#include <eunoe/core/problems.h>
#include <eunoe/engine/particle_system.h>

#include <algorithm>
#include <utility>

namespace eunoe {

ParticleSystem::ParticleSystem(Domain &domain, ParticlePhysics physics_, const double skin,
                               const double largest_diameter, Timers &timers)
    : domain(domain), physics(std::move(physics_)), model(physics.model),
      largest_diameter(largest_diameter), skin(skin), ledger(domain.outlets().size()),
      timers(timers), store(domain, 1.001 * (largest_diameter + skin + model.range()),
                            reach_of_ghosts(), physics.fields.n_components(), physics.asleep),
      halo(domain.communicator()), grid(new_grid()), pair_forces(model, domain.periods()),
      solid_contacts(physics.wall_model), rows(model.history_size()),
      extra_defaults(physics.fields.initial_values())
{
  pairs.clear(model.history_size());
  particles.gravity = physics.gravity;
}

double ParticleSystem::largest_drift() const
{
  return std::clamp(0.5 * largest_diameter, 2. * skin, 4. * skin);
}

double ParticleSystem::reach_of_ghosts() const
{
  return 1.001 * (largest_diameter + skin + 2. * largest_drift() + model.range());
}

ContactGrid ParticleSystem::new_grid() const
{
  const Box box = domain.box_from_centre();
  return {box.lower, box.upper, domain.periods(), largest_diameter + skin + model.range()};
}

void ParticleSystem::set_skin(const double wanted)
{
  skin = wanted;
  // The cells of the mesh stay: they may be wider or narrower than a search reaches.
  store.set_reach(reach_of_ghosts());
  grid = new_grid();
}

SearchLoad ParticleSystem::search_load() const
{
  std::uint64_t n_pairs = 0;
  // Of a pair across a border of ranks the owner of the first one counts.
  for (const std::int32_t row : pairs.i)
    n_pairs += static_cast<std::size_t>(row) < particles.n_owned ? 1 : 0;
  std::uint64_t sums[3] = {particles.n_owned, particles.n_awake(), n_pairs};
  MPI_Allreduce(MPI_IN_PLACE, sums, 3, MPI_UINT64_T, MPI_SUM, domain.communicator());
  return {sums[0], sums[1], sums[2]};
}

void ParticleSystem::add_forces(const std::vector<Solid> &solids, const double time,
                                const double dt, std::vector<SolidLoad> *on_solids)
{
  {
    const Timers::Scope scope(timers, Section::loads);
    for (const auto &load : physics.loads)
      load->add(particles, time);
  }
  {
    const Timers::Scope scope(timers, Section::pairs);
    pair_forces.add(particles, pairs, dt);
  }
  const Timers::Scope scope(timers, Section::solids);
  solid_contacts.add_forces(particles, solids, time, dt, on_solids);
}

void ParticleSystem::forget_contacts(const bool between_particles, const bool with_solids)
{
  if (between_particles) {
    std::fill(pairs.record.begin(), pairs.record.end(), ContactMemory::none);
    pairs.memory.clear(model.history_size());
    pairs.near.forget();
  }
  if (with_solids)
    solid_contacts.forget();
}

void ParticleSystem::update_sleep(const SparseContacts &sparse, const Stirring &stirring)
{
  sparse.update(particles, pairs, solid_contacts, halo, domain.periods(), stirring);
  // Also the ghosts that have just fallen asleep.
  halo.include_sleepers();
  halo.update(particles);
  leave_out_sleepers();
}

void ParticleSystem::leave_out_sleepers()
{
  halo.leave_out_sleepers(particles);
  pairs.some_sleep = !particles.awake.empty();
  pairs.awake.clear();
  pairs.near.forget();
  particles.pressed_rows.clear();
  if (!pairs.some_sleep)
    return;
  particles.clear_forces_on_sleepers();
  std::vector<std::uint8_t> is_pressed(particles.size(), 0);
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if ((particles.awake[pairs.i[k]] | particles.awake[pairs.j[k]]) != 0) {
      pairs.awake.push_back(static_cast<std::int32_t>(k));
      is_pressed[pairs.i[k]] = is_pressed[pairs.j[k]] = 1;
    }
  for (const SolidContacts::Candidate &candidate : solid_contacts.get_candidates())
    is_pressed[candidate.particle] = 1;
  for (std::size_t row = 0; row < particles.n_owned; ++row)
    if (is_pressed[row] != 0 && particles.awake[row] == 0)
      particles.pressed_rows.push_back(static_cast<std::int32_t>(row));
}

void ParticleSystem::add_loads(const std::vector<std::size_t> &list, const double time)
{
  if (physics.loads.empty())
    return;
  // In portions: there may be as many as there are particles.
  constexpr std::size_t portion = 4096;
  ParticleArrays some;
  for (std::size_t begin = 0; begin < list.size(); begin += portion) {
    const std::size_t n = std::min(portion, list.size() - begin);
    some.resize(n, 0, static_cast<unsigned int>(particles.extra.size()));
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t row = list[begin + k];
      some.position[k] = particles.position[row];
      some.velocity[k] = particles.velocity[row];
      some.spin[k] = particles.spin[row];
      some.force[k] = some.torque[k] = Quad();
      some.id[k] = particles.id[row];
      some.type[k] = particles.type[row];
      some.reference[k] = particles.reference[row];
      for (std::size_t e = 0; e < some.extra.size(); ++e)
        some.extra[e][k] = particles.extra[e][row];
    }
    for (const auto &load : physics.loads)
      load->add(some, time);
    for (std::size_t k = 0; k < n; ++k) {
      particles.force[list[begin + k]].add(some.force[k].vec());
      particles.torque[list[begin + k]].add(some.torque[k].vec());
    }
  }
}

void ParticleSystem::start_forces_on_new(const ParticleId first_new,
                                         const std::vector<Solid> &solids, const double time)
{
  ParticleArrays &p = particles;
  const auto is_new = [&](const std::int32_t row) {
    return static_cast<std::size_t>(row) < p.n_owned && p.id[row] >= first_new;
  };
  std::vector<std::size_t> awake;
  for (std::size_t row = 0; row < p.n_owned; ++row)
    if (p.id[row] >= first_new) {
      p.force[row] = p.torque[row] = Quad();
      if (p.is_awake(row)) {
        p.start_forces(row);
        awake.push_back(row);
      }
    }
  add_loads(awake, time);

  std::vector<std::int32_t> places;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const std::int32_t i = pairs.i[k], j = pairs.j[k];
    if ((is_new(i) || is_new(j)) && (p.is_awake(i) || p.is_awake(j)))
      places.push_back(static_cast<std::int32_t>(k));
  }
  pair_forces.evaluate(p, pairs, &places, [&](const ContactForce &contact) {
    if (is_new(contact.first)) {
      p.force[contact.first].add(-contact.force());
      p.torque[contact.first].add(contact.torque_on_first(p.radius(contact.first)));
    }
    if (is_new(contact.second)) {
      p.force[contact.second].add(contact.force());
      p.torque[contact.second].add(contact.torque_on_second(p.radius(contact.second)));
    }
  });
  solid_contacts.evaluate(p, solids, time, [&](const ContactForce &contact) {
    if (!is_new(contact.first) || !p.is_awake(contact.first))
      return;
    p.force[contact.first].add(-contact.force());
    p.torque[contact.first].add(contact.torque_on_first(p.radius(contact.first)));
  });
}

void ParticleSystem::add_solid_loads(const std::vector<Solid> &solids, const double time,
                                     std::vector<SolidLoad> &loads) const
{
  solid_contacts.evaluate(particles, solids, time, [&](const ContactForce &contact) {
    const Vec3 point = particles.position[contact.first].vec() + contact.distance * contact.normal;
    loads[contact.solid].add(contact.force(),
                             cross(point - solids[contact.solid].state.centre, contact.force()) -
                                 contact.rolling_torque);
  });
}

std::vector<ContactForce> ParticleSystem::contact_forces(const std::vector<Solid> &solids,
                                                         const double time) const
{
  std::vector<ContactForce> list;
  const auto append = [&list](const ContactForce &contact) { list.push_back(contact); };
  pair_forces.evaluate(particles, pairs, nullptr, append);
  solid_contacts.evaluate(particles, solids, time, append);
  return list;
}

} // namespace eunoe
