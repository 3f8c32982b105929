// Searches: how particles come to the ranks that own them, and the lists of what can touch.

#include <eunoe/engine/load_balancing.h>
#include <eunoe/engine/particle_system.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace eunoe {

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

ContactRows ParticleSystem::contact_rows() const
{
  ContactRows collected(model.history_size());
  collected.collect(particles, pairs, solid_contacts);
  return collected;
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

void ParticleSystem::use_pairs()
{
  pairs.trim();
  halo.leave_out_unpaired(particles, pairs);
}

std::vector<Origin> ParticleSystem::build_lists(const std::vector<Solid> &solids)
{
  std::vector<Origin> origins;
  grid.move_to(domain.centre());
  store.read(particles, grid, origins);
  halo.build(particles, store, grid, skin + 2. * largest_drift() + model.range());
  drift = 0.;
  pairs.clear(model.history_size());
  grid.find_pairs(particles, skin + model.range(), pairs, &found);
  use_pairs();
  make_room_for_contacts();
  solid_contacts.search(particles, solids, skin + physics.wall_model.range());
  return origins;
}

void ParticleSystem::rebuild(const std::vector<Solid> &solids,
                             const LoadBalancingParameters *balance)
{
  store.migrate();
  // Cells are about two diameters wide, so that the number of particles in them has hardly changed
  // before. What has come is anywhere.
  unadapted += drift;
  if (balance != nullptr || !(unadapted < 2. * largest_diameter)) {
    store.adapt();
    unadapted = 0.;
  }
  if (balance != nullptr) {
    store.repartition(*balance);
    ++balances;
  }
  const std::vector<Origin> origins = build_lists(solids);
  rows.attach(fetch_rows(rows.get_rows(), origins, domain.communicator()), particles, pairs,
              solid_contacts);
  ++searches;
}

std::vector<ContactGrid::Moved> ParticleSystem::follow(const double farthest)
{
  // References in a domain that moves are where it was at the last search. However far the farthest
  // has gone, two others that keep theirs must not use up the skin.
  const double little =
      std::isfinite(farthest) && !domain.moves() ? 0.25 * std::min(farthest, skin) : 0.;
  std::vector<ContactGrid::Moved> moved;
  for (std::size_t row = 0; row < particles.n_owned; ++row) {
    Quad &x = particles.position[row];
    Vec3 &reference = particles.reference[row];
    if (!(norm_square(x.vec() - reference) > little * little))
      continue;
    moved.push_back({static_cast<std::int32_t>(row), reference});
    reference = domain.periods().wrap(x.vec());
    x = {reference.x, reference.y, reference.z, x.w};
  }
  return moved;
}

void ParticleSystem::search(const std::vector<Solid> &solids, const double farthest,
                            const LoadBalancingParameters *balance,
                            const std::vector<std::size_t> &lost)
{
  const std::vector<std::size_t> leaving = count_leaving(lost);
  rows.collect(particles, pairs, solid_contacts);
  follow(farthest);
  store.write(particles, work());
  store.remove(leaving);
  rebuild(solids, balance);
}

std::vector<std::uint8_t> ParticleSystem::cut_off(const std::vector<std::size_t> &leaving,
                                                  std::vector<ContactGrid::Moved> &moved)
{
  std::vector<std::uint8_t> leaves(particles.size(), 0);
  for (const std::size_t row : leaving)
    leaves[row] = 1;
  halo.update(leaves);
  pairs.end_contacts(leaves);
  for (std::size_t row = 0; row < particles.size(); ++row)
    if (leaves[row] != 0) {
      Vec3 &reference = particles.reference[row];
      moved.push_back({static_cast<std::int32_t>(row), reference});
      reference.x = std::numeric_limits<double>::quiet_NaN();
    }
  return leaves;
}

void ParticleSystem::leave_out(const Remaining &remaining, const std::uint64_t n)
{
  particles.leave_out(remaining);
  pairs.leave_out(remaining);
  remaining.keep(found.groups);
  halo.leave_out(remaining);
  solid_contacts.leave_out(remaining);
  store.leave_out(remaining, n);
}

bool ParticleSystem::search_again(const std::vector<Solid> &solids, const double farthest,
                                  const std::vector<std::size_t> &lost)
{
  // On one rank particles need no ghosts; what has moved farther lies far from its neighbours in
  // memory.
  constexpr double diameters_on_one_rank = 5.;
  int n_ranks;
  MPI_Comm_size(domain.communicator(), &n_ranks);
  drift += farthest;
  if (!(drift <= (n_ranks > 1 ? largest_drift() : diameters_on_one_rank * largest_diameter)))
    return false;
  const std::vector<std::size_t> leaving = count_leaving(lost);
  std::uint64_t n_leaving = leaving.size();
  MPI_Allreduce(MPI_IN_PLACE, &n_leaving, 1, MPI_UINT64_T, MPI_SUM, domain.communicator());

  std::vector<ContactGrid::Moved> moved = follow(farthest);
  particles.wake_all();
  halo.update_all(particles, moved);
  std::vector<std::uint8_t> leaves;
  if (n_leaving > 0)
    leaves = cut_off(leaving, moved);
  grid.move_to(domain.centre());
  grid.find_pairs_again(particles, skin + model.range(), moved, pairs, found);
  if (n_leaving > 0)
    leave_out(Remaining(leaves), n_leaving);
  use_pairs();
  solid_contacts.search_again(particles, solids, skin + physics.wall_model.range());
  ++searches;
  ++searches_in_place;
  return true;
}

ParticleId ParticleSystem::insert_and_remove(Delivery delivery,
                                             const std::vector<std::size_t> &removed,
                                             const std::vector<std::size_t> &lost,
                                             const std::vector<Solid> &solids,
                                             const LoadBalancingParameters *const first_sharing)
{
  std::vector<std::size_t> leaving = count_leaving(lost);
  rows.collect(particles, pairs, solid_contacts);
  follow(0.);
  store.write(particles, work());
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
  ParticleId first_new = std::numeric_limits<ParticleId>::max();
  for (const NewParticle &particle : delivery.particles)
    first_new = std::min(first_new, particle.id);
  store.insert(std::move(delivery.particles), extra_defaults, std::move(origins));
  unadapted = std::numeric_limits<double>::infinity();
  if (first_sharing != nullptr) {
    store.migrate();
    store.adapt();
    unadapted = 0.;
    if (store.imbalance(*first_sharing) > first_sharing->threshold_at_start) {
      store.repartition(*first_sharing);
      ++balances;
    }
  }
  rebuild(solids, nullptr);

  MPI_Allreduce(MPI_IN_PLACE, &first_new, 1, MPI_UINT32_T, MPI_MIN, domain.communicator());
  return first_new;
}

} // namespace eunoe
