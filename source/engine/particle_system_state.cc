// The particles and their contacts in a checkpoint: a row of doubles per particle.

#include <eunoe/checkpoint/checkpoint_file.h>
#include <eunoe/engine/load_balancing.h>
#include <eunoe/engine/particle_system.h>
#include <eunoe/engine/saved_layout.h>

#include <limits>

namespace eunoe {

namespace {

/// Places in a row; behind the last come the extra doubles, then the contacts.
enum Place : unsigned int
{
  id,
  type,
  radius,
  mass,
  reference, ///< on which the order of all lists depends
  position = reference + 3,
  velocity = position + 3,
  spin = velocity + 3,
  force = spin + 3,
  torque = force + 3,
  n_places = torque + 3
};

void put(const Vec3 &v, double *place)
{
  place[0] = v.x;
  place[1] = v.y;
  place[2] = v.z;
}

Vec3 get(const double *place)
{
  return {place[0], place[1], place[2]};
}

void set(Quad &q, const double *place)
{
  q.x = place[0];
  q.y = place[1];
  q.z = place[2];
}

} // namespace

Rows ParticleSystem::rows_to_save() const
{
  const ParticleArrays &p = particles;
  const ContactRows collected = contact_rows();
  const Rows &contacts = collected.get_rows();
  const std::size_t n_fixed = n_places + p.extra.size();
  Rows all;
  // So that the vectors do not take twice as much.
  all.starts.reserve(p.n_owned + 1);
  all.values.reserve(n_fixed * p.n_owned + contacts.values.size());
  std::vector<double> row;
  for (std::size_t k = 0; k < p.n_owned; ++k) {
    row.assign(n_fixed, 0.);
    row[id] = p.id[k];
    row[type] = p.type[k];
    row[radius] = p.radius(k);
    row[mass] = p.mass(k);
    put(p.reference[k], &row[reference]);
    put(p.position[k].vec(), &row[position]);
    put(p.velocity[k].vec(), &row[velocity]);
    put(p.spin[k].vec(), &row[spin]);
    put(p.force[k].vec(), &row[force]);
    put(p.torque[k].vec(), &row[torque]);
    for (std::size_t e = 0; e < p.extra.size(); ++e)
      row[n_places + e] = p.extra[e][k];
    row.insert(row.end(), contacts[k], contacts[k] + contacts.length(k));
    all.append(row.data(), row.data() + row.size());
  }
  return all;
}

void ParticleSystem::save(CheckpointWriter &writer) const
{
  const auto end = particles.id.begin() + static_cast<std::ptrdiff_t>(particles.n_owned);
  const std::vector<ParticleId> keys(particles.id.begin(), end);
  writer.add_rows("particles", keys, rows_to_save());
  writer.head["ledger"] = ledger.save(domain.communicator());
  SavedLayout::write(writer.head, physics.fields, physics.model, physics.wall_model);
}

int ParticleSystem::outlet_passed(const double *const row) const
{
  return domain.passed_outlet(get(row + reference), get(row + position));
}

void ParticleSystem::check_guests(const Rows &rows, const std::string &path) const
{
  std::uint64_t n_outside = 0;
  double largest[2] = {0., 0.}; // type, radius
  for (std::size_t k = 0; k < rows.size(); ++k) {
    n_outside += domain.contains(get(rows[k] + position)) || outlet_passed(rows[k]) >= 0 ? 0 : 1;
    largest[0] = std::max(largest[0], rows[k][type]);
    largest[1] = std::max(largest[1], rows[k][radius]);
  }
  MPI_Allreduce(MPI_IN_PLACE, &n_outside, 1, MPI_UINT64_T, MPI_SUM, domain.communicator());
  MPI_Allreduce(MPI_IN_PLACE, largest, 2, MPI_DOUBLE, MPI_MAX, domain.communicator());
  Problems problems;
  if (n_outside > 0)
    problems.add(path,
                 "holds " + std::to_string(n_outside) +
                     " particles that lie outside the mesh of this input.",
                 "Give a mesh around them, or let them leave before the checkpoint.");
  const int n_types = model.get_materials().n_types();
  if (largest[0] >= n_types)
    problems.add(path,
                 "holds particles of type " + format(largest[0]) +
                     ", and the input has the types 0 to " + std::to_string(n_types - 1) + ".",
                 "Describe all types that are present.");
  if (2. * largest[1] > largest_diameter * (1. + 1e-12))
    problems.add(path,
                 "holds particles of up to " + format(2. * largest[1]) +
                     " m, and those of the input have " + format(largest_diameter) +
                     " m at most, for which contacts are searched.",
                 "Give the sizes of the particles that are present.");
  if (!problems.empty())
    throw UserError(problems);
}

void ParticleSystem::check_guests(const Checkpoint &checkpoint,
                                  const std::vector<Solid> &solids) const
{
  rows_of(checkpoint, {checkpoint.head, physics.fields, physics.model, physics.wall_model, solids},
          true);
}

const Rows &ParticleSystem::rows_of(const Checkpoint &checkpoint, const SavedLayout &layout,
                                    const bool begins_phase) const
{
  const Rows &share = checkpoint.rows("particles");
  const std::size_t n_fixed = n_places + layout.n_extra();
  const double n_types =
      begins_phase ? std::numeric_limits<int>::max() : model.get_materials().n_types();
  bool ok = begins_phase || (layout.n_extra() == extra_defaults.size() &&
                             layout.n_history() == model.history_size());
  for (std::size_t k = 0; k < share.size(); ++k)
    ok = ok && share.length(k) >= n_fixed && are_of_particle(share[k] + id, n_types) &&
         ContactRows::are_records(share[k] + n_fixed, share[k] + share.length(k),
                                  layout.n_history());
  checkpoint.require(ok, "its particles are not those of the case.");
  if (begins_phase)
    check_guests(share, checkpoint.path);
  return share;
}

std::vector<std::string> ParticleSystem::load(const Checkpoint &checkpoint,
                                              const std::vector<Solid> &solids,
                                              const LoadBalancingParameters &balancing,
                                              const SparseContacts &sparse, const bool begins_phase,
                                              const bool keeps_ledger)
{
  MPI_Comm comm = domain.communicator();
  const SavedLayout layout(checkpoint.head, physics.fields, physics.model, physics.wall_model,
                           solids);
  if (keeps_ledger)
    ledger.load(checkpoint.head.at("ledger"), comm);
  int rank;
  MPI_Comm_rank(comm, &rank);
  const Rows &share = rows_of(checkpoint, layout, begins_phase);
  const std::size_t n_fixed = n_places + layout.n_extra();
  std::vector<NewParticle> list;
  std::vector<Origin> kept;
  for (std::size_t k = 0; k < share.size(); ++k) {
    const double *const row = share[k];
    // A run may end before those are taken out that have passed an outlet.
    if (const int outlet = begins_phase ? outlet_passed(row) : -1; outlet >= 0) {
      if (keeps_ledger)
        ledger.through_outlet[outlet].count(row[mass]);
      continue;
    }
    NewParticle particle;
    particle.id = static_cast<ParticleId>(row[id]);
    particle.type = static_cast<int>(row[type]);
    particle.radius = row[radius];
    particle.mass = row[mass];
    // The lists of the last search belong to the old input.
    particle.position =
        begins_phase ? domain.periods().wrap(get(row + position)) : get(row + reference);
    list.push_back(particle);
    kept.push_back({rank, static_cast<std::int32_t>(k)});
    if (!keeps_ledger)
      ledger.inserted.count(particle.mass);
  }
  store.insert(std::move(list), extra_defaults, std::move(kept));
  store.adapt();
  if (store.imbalance(balancing) > balancing.threshold_at_start)
    store.repartition(balancing);
  const RowViews mine = fetch_rows(share, build_lists(solids), comm);

  Rows contacts;
  ParticleArrays &p = particles;
  for (std::size_t k = 0; k < p.n_owned; ++k) {
    const double *const row = mine[k];
    if (!begins_phase)
      set(p.position[k], row + position);
    set(p.velocity[k], row + velocity);
    set(p.spin[k], row + spin);
    set(p.force[k], row + force);
    set(p.torque[k], row + torque);
    for (std::size_t e = 0; e < p.extra.size(); ++e)
      if (layout.extra(e) >= 0)
        p.extra[e][k] = row[n_places + static_cast<std::size_t>(layout.extra(e))];
    contacts.append(row + n_fixed, row + mine.length(k));
  }
  if (begins_phase)
    contacts = layout.translate(contacts);
  ContactRows(model.history_size()).attach(RowViews(contacts), particles, pairs, solid_contacts);
  halo.update(particles);
  if (sparse.is_enabled() && !begins_phase) {
    sparse.recall(particles, halo);
    leave_out_sleepers();
  }
  return layout.losses();
}

} // namespace eunoe
