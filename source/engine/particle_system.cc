#include <eunoe/core/problems.h>
#include <eunoe/engine/load_balancing.h>
#include <eunoe/engine/particle_system.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace eunoe {

ParticleSystem::ParticleSystem(Domain &domain, ParticlePhysics physics_, const double skin,
                               const double largest_diameter, Timers &timers)
    : domain(domain), physics(std::move(physics_)), model(physics.model), skin(skin),
      largest_diameter(largest_diameter), ledger(domain.outlets().size()), timers(timers),
      store(domain, 1.001 * (largest_diameter + skin + model.range()),
            physics.fields.n_components(), physics.asleep),
      halo(domain.communicator()),
      grid(domain.box_from_centre().lower, domain.box_from_centre().upper, domain.periods(),
           largest_diameter + skin + model.range()),
      pair_forces(model, domain.periods()), solid_contacts(physics.wall_model),
      rows(model.history_size()), extra_defaults(physics.fields.initial_values())
{
  pairs.clear(model.history_size());
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

void ParticleSystem::forget_contacts()
{
  std::fill(pairs.record.begin(), pairs.record.end(), ContactMemory::none);
  pairs.memory.clear(model.history_size());
  solid_contacts.forget();
}

void ParticleSystem::update_sleep(const SparseContacts &sparse, const Stirring &stirring)
{
  sparse.update(particles, pairs, solid_contacts, halo, stirring);
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
  if (!pairs.some_sleep)
    return;
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if ((particles.awake[pairs.i[k]] | particles.awake[pairs.j[k]]) != 0)
      pairs.awake.push_back(static_cast<std::int32_t>(k));
}

ContactRows ParticleSystem::contact_rows() const
{
  ContactRows collected(model.history_size());
  collected.collect(particles, pairs, solid_contacts);
  return collected;
}

std::vector<double> ParticleSystem::work() const
{
  // Shares of a step's time, measured on a settled bed, where a particle has four listed pairs and
  // two to three contacts.
  constexpr double of_particle = 0.15, of_pair = 0.04, of_contact = 0.28;
  std::vector<double> work(particles.size(), of_particle);
  int n_ranks;
  MPI_Comm_size(domain.communicator(), &n_ranks);
  if (n_ranks == 1)
    return work;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const double half = 0.5 * (is_within_reach(k) ? of_pair + of_contact : of_pair);
    work[pairs.i[k]] += half;
    work[pairs.j[k]] += half;
  }
  for (const SolidContacts::Candidate &candidate : solid_contacts.get_candidates())
    work[candidate.particle] += of_contact;
  return work;
}

std::vector<std::pair<std::size_t, int>> ParticleSystem::beyond_outlets() const
{
  std::vector<std::pair<std::size_t, int>> found;
  if (domain.outlets().empty())
    return found;
  for (std::size_t row = 0; row < particles.n_owned; ++row) {
    const int outlet =
        domain.passed_outlet(particles.reference[row], particles.position[row].vec());
    if (outlet >= 0)
      found.emplace_back(row, outlet);
  }
  return found;
}

std::vector<std::size_t> ParticleSystem::count_leaving(const std::vector<std::size_t> &lost)
{
  std::vector<std::size_t> leaving;
  for (const auto &[row, outlet] : beyond_outlets()) {
    ledger.through_outlet[outlet].count(particles.mass(row));
    leaving.push_back(row);
  }
  for (const std::size_t row : lost) {
    ledger.lost.count(particles.mass(row));
    leaving.push_back(row);
  }
  return leaving;
}

void ParticleSystem::stir_around_leaving(const SparseContacts &sparse,
                                         const std::vector<std::size_t> &lost,
                                         const unsigned long long step)
{
  std::vector<std::uint8_t> leaves(particles.size(), 0);
  for (const std::size_t row : lost)
    leaves[row] = 1;
  for (const auto &[row, outlet] : beyond_outlets())
    leaves[row] = 1;
  halo.update(leaves);
  sparse.stir_neighbours(particles, pairs, leaves, step);
}

void ParticleSystem::search(const std::vector<Solid> &solids,
                            const LoadBalancingParameters *balance,
                            const std::vector<std::size_t> &lost)
{
  rows.collect(particles, pairs, solid_contacts);
  store.write(particles, work());
  store.remove(count_leaving(lost));
  rebuild(solids, balance);
}

ParticleId ParticleSystem::insert_and_remove(const Delivery &delivery,
                                             const std::vector<std::size_t> &removed,
                                             const std::vector<std::size_t> &lost,
                                             const std::vector<Solid> &solids)
{
  rows.collect(particles, pairs, solid_contacts);
  store.write(particles, work());
  std::vector<std::size_t> leaving = count_leaving(lost);
  std::vector<bool> has_left(particles.n_owned, false);
  for (const std::size_t row : leaving)
    has_left[row] = true;
  for (const std::size_t row : removed)
    if (!has_left[row]) {
      ledger.taken_out.count(particles.mass(row));
      leaving.push_back(row);
    }
  store.remove(leaving);

  int rank;
  MPI_Comm_rank(domain.communicator(), &rank);
  std::vector<Origin> origins(delivery.particles.size());
  for (std::size_t k = 0; k < delivery.particles.size(); ++k) {
    ledger.inserted.count(delivery.particles[k].mass);
    if (!delivery.has_rows)
      continue;
    origins[k] = {rank, static_cast<std::int32_t>(rows.size())};
    rows.start_row();
    for (const ContactRows::Record &record : delivery.rows.records(k))
      rows.add(record);
  }
  store.insert(delivery.particles, extra_defaults, origins);
  rebuild(solids, nullptr);

  ParticleId first_new = std::numeric_limits<ParticleId>::max();
  for (const NewParticle &particle : delivery.particles)
    first_new = std::min(first_new, particle.id);
  MPI_Allreduce(MPI_IN_PLACE, &first_new, 1, MPI_UINT32_T, MPI_MIN, domain.communicator());
  return first_new;
}

void ParticleSystem::add_loads(const std::vector<std::size_t> &list, const double time)
{
  ParticleArrays some;
  some.resize(list.size(), 0, static_cast<unsigned int>(particles.extra.size()));
  for (std::size_t k = 0; k < list.size(); ++k) {
    const std::size_t row = list[k];
    some.position[k] = particles.position[row];
    some.velocity[k] = particles.velocity[row];
    some.spin[k] = particles.spin[row];
    some.id[k] = particles.id[row];
    some.type[k] = particles.type[row];
    some.reference[k] = particles.reference[row];
    for (std::size_t e = 0; e < some.extra.size(); ++e)
      some.extra[e][k] = particles.extra[e][row];
  }
  for (const auto &load : physics.loads)
    load->add(some, time);
  for (std::size_t k = 0; k < list.size(); ++k) {
    particles.force[list[k]].add(some.force[k].vec());
    particles.torque[list[k]].add(some.torque[k].vec());
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
      if (p.is_awake(row))
        awake.push_back(row);
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

std::vector<ContactForce> ParticleSystem::contact_forces(const std::vector<Solid> &solids,
                                                         const double time) const
{
  std::vector<ContactForce> list;
  const auto append = [&list](const ContactForce &contact) { list.push_back(contact); };
  pair_forces.evaluate(particles, pairs, nullptr, append);
  solid_contacts.evaluate(particles, solids, time, append);
  return list;
}

void ParticleSystem::rebuild(const std::vector<Solid> &solids,
                             const LoadBalancingParameters *balance)
{
  store.migrate();
  store.adapt();
  if (balance != nullptr) {
    store.repartition(*balance);
    ++balances;
  }
  const std::vector<Origin> origins = build_lists(solids);
  rows.attach(fetch_rows(rows.get_rows(), origins, domain.communicator()), particles, pairs,
              solid_contacts);
  ++searches;
}

bool ParticleSystem::is_within_reach(const std::size_t pair) const
{
  const std::int32_t i = pairs.i[pair], j = pairs.j[pair];
  const double reach = particles.radius(i) + particles.radius(j) + model.range();
  const Vec3 apart = particles.position[j].vec() - particles.position[i].vec();
  return norm_square(domain.periods().shortest(apart)) <= reach * reach;
}

void ParticleSystem::make_room_for_contacts()
{
  // Only when there are many more pairs than ever before: it costs as much as a step.
  if (pairs.size() <= pairs_with_room)
    return;
  pairs_with_room = pairs.size() + pairs.size() / 10;
  std::size_t n = 0;
  for (std::size_t k = 0; k < pairs.size(); ++k)
    n += is_within_reach(k) ? 1 : 0;
  pairs.memory.reserve(n + n / 5);
}

std::vector<Origin> ParticleSystem::build_lists(const std::vector<Solid> &solids)
{
  std::vector<Origin> origins;
  grid.move_to(domain.centre());
  store.read(particles, grid, origins);
  halo.build(particles, store, grid, skin + model.range());
  pairs.clear(model.history_size());
  grid.find_pairs(particles, skin + model.range(), pairs);
  pairs.trim();
  halo.leave_out_unpaired(particles, pairs);
  make_room_for_contacts();
  solid_contacts.search(particles, solids, skin + physics.wall_model.range());
  return origins;
}

} // namespace eunoe
