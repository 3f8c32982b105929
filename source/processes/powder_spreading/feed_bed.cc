#include <eunoe/checkpoint/checkpoint_file.h>
#include <eunoe/checkpoint/head_values.h>
#include <eunoe/core/key_ranges.h>
#include <eunoe/core/random.h>
#include <eunoe/engine/saved_layout.h>
#include <eunoe/processes/box_mesh.h>
#include <eunoe/processes/powder_spreading/feed_bed.h>

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

namespace eunoe::spreading {

namespace {

/// Places in a row of a checkpoint; behind the last come the contacts.
namespace place {
constexpr unsigned int id = 0, type = 1, radius = 2, mass = 3, position = 4, velocity = 7,
                       spin = 10, n_places = 13;
} // namespace place

Vec3 vector_at(const double *values)
{
  return {values[0], values[1], values[2]};
}

/// Number of the wall at a side of the domain; that of no solid if particles pass there.
std::uint32_t find_wall(const Simulation &simulation, const unsigned int side)
{
  const std::vector<Solid> &solids = simulation.get_solids();
  const auto wall = std::find_if(solids.begin(), solids.end(),
                                 [side](const Solid &solid) { return solid.boundary == side; });
  return static_cast<std::uint32_t>(wall - solids.begin());
}

/// Numbers of the bed's particles in the order of their ids, and -1 for others that touch them: of
/// those of which this rank knows.
/// @param bed rows of owned particles
std::unordered_map<ParticleId, std::int64_t> numbers_in_bed(const ParticleArrays &p,
                                                            const std::vector<std::size_t> &bed,
                                                            const ContactRows &contacts,
                                                            MPI_Comm comm)
{
  std::vector<ParticleId> ids;
  std::unordered_set<ParticleId> known;
  for (const std::size_t row : bed) {
    ids.push_back(p.id[row]);
    known.insert(p.id[row]);
    for (const ContactRows::Record &record : contacts.records(row))
      if (!record.with_solid)
        known.insert(record.partner);
  }
  const std::vector<ParticleId> asked(known.begin(), known.end());
  const std::vector<std::int64_t> places = places_in_order(ids, asked, comm);
  std::unordered_map<ParticleId, std::int64_t> numbers;
  for (std::size_t k = 0; k < asked.size(); ++k)
    numbers[asked[k]] = places[k];
  return numbers;
}

} // namespace

std::vector<std::size_t> above_level(const ParticleArrays &p, const Apparatus &apparatus)
{
  std::vector<std::size_t> found;
  for (std::size_t row = 0; row < p.n_owned; ++row)
    if (apparatus.is_in_reservoir(p.position[row].vec()) &&
        p.position[row].y + p.radius(row) > apparatus.bed_level)
      found.push_back(row);
  return found;
}

std::vector<std::size_t> in_reservoir(const ParticleArrays &p, const Apparatus &apparatus)
{
  std::vector<std::size_t> found;
  for (std::size_t row = 0; row < p.n_owned; ++row)
    if (apparatus.is_in_reservoir(p.position[row].vec()))
      found.push_back(row);
  return found;
}

std::vector<std::size_t> in_the_way(const ParticleArrays &p, const Apparatus &apparatus)
{
  return apparatus.bed_level == 0. ? in_reservoir(p, apparatus)
                                   : reaching_into_reservoir(p, apparatus);
}

std::vector<std::size_t> reaching_into_reservoir(const ParticleArrays &p,
                                                 const Apparatus &apparatus)
{
  std::vector<std::size_t> found;
  for (std::size_t row = 0; row < p.n_owned; ++row)
    if (p.position[row].x - p.radius(row) < apparatus.x_transfer)
      found.push_back(row);
  return found;
}

void FeedBed::take(Simulation &simulation, const Apparatus &apparatus, const double platform_height)
{
  const ParticleArrays &p = simulation.complete_step();
  const ContactRows all_rows = simulation.get_system().contact_rows();
  std::vector<std::size_t> found = in_reservoir(p, apparatus);
  // What lies on the edge of the transfer plate would stand in its wall in a lower copy.
  found.erase(std::remove_if(found.begin(), found.end(),
                             [&](const std::size_t row) {
                               const double r = p.radius(row);
                               return p.position[row].y + r > 0. &&
                                      p.position[row].x + r > apparatus.x_transfer;
                             }),
              found.end());
  const auto numbers = numbers_in_bed(p, found, all_rows, simulation.communicator());
  const auto number_of = [&](ParticleId id) { return numbers.at(id); };

  n_global = found.size();
  MPI_Allreduce(MPI_IN_PLACE, &n_global, 1, MPI_UINT64_T, MPI_SUM, simulation.communicator());
  depth = apparatus.bed_level - platform_height;
  particles.clear();
  rows = ContactRows(simulation.contact_model().history_size());
  for (const std::size_t row : found) {
    NewParticle particle;
    particle.id = static_cast<ParticleId>(number_of(p.id[row]));
    particle.type = p.type[row];
    particle.radius = p.radius(row);
    particle.mass = p.mass(row);
    particle.position = p.position[row].vec() - Vec3{0., platform_height, 0.};
    particle.velocity = p.velocity[row].vec();
    particle.spin = p.spin[row].vec();
    particles.push_back(particle);
    rows.start_row();
    for (ContactRows::Record record : all_rows.records(row)) {
      if (!record.with_solid) {
        const auto partner = number_of(record.partner);
        if (partner < 0)
          continue;
        record.partner = static_cast<std::uint32_t>(partner);
      }
      rows.add(record);
    }
  }
}

Delivery FeedBed::stack(Simulation &simulation, const Apparatus &apparatus,
                        const double platform_height, const unsigned int seed,
                        const unsigned int event) const
{
  const ParticleSystem &system = simulation.get_system();
  const unsigned int n_history = system.contact_model().history_size();
  Delivery delivery;
  delivery.rows = ContactRows(n_history);
  delivery.has_rows = true;
  std::vector<double> history(n_history);

  const bool has_walls = !simulation.get_domain().periods().is_periodic(2);
  const std::uint32_t lower = find_wall(simulation, box_side::lower_z);
  const std::uint32_t upper = find_wall(simulation, box_side::upper_z);
  const auto opposite_wall = [=](std::uint32_t solid) {
    return solid == lower ? upper : solid == upper ? lower : solid;
  };
  const double height = apparatus.bed_level - platform_height;
  const auto n_copies = static_cast<unsigned int>(std::ceil(height / depth - 1e-9));
  for (unsigned int copy = 0; copy < n_copies; ++copy) {
    const std::uint64_t draw = (static_cast<std::uint64_t>(event) << 32) + copy;
    const bool mirrored = uniform(seed, Draw::feed_copy, draw, 1) < 0.5;
    // Between side walls a copy can be mirrored alone.
    const double shift = !has_walls ? apparatus.depth * uniform(seed, Draw::feed_copy, draw, 0)
                         : mirrored ? apparatus.depth
                                    : 0.;
    const ParticleId first = simulation.take_ids(n_global);
    for (std::size_t k = 0; k < particles.size(); ++k) {
      NewParticle particle = particles[k];
      particle.position.y += platform_height + copy * depth;
      if (particle.position.y + particle.radius > apparatus.bed_level)
        continue;
      particle.id += first;
      if (mirrored) {
        particle.position.z = -particle.position.z;
        particle.velocity.z = -particle.velocity.z;
        particle.spin.x = -particle.spin.x;
        particle.spin.y = -particle.spin.y;
      }
      particle.position.z += shift;
      delivery.particles.push_back(particle);
      delivery.rows.start_row();
      for (ContactRows::Record record : rows.records(k)) {
        if (!record.with_solid)
          record.partner += first;
        else if (mirrored && has_walls)
          record.partner = opposite_wall(record.partner);
        std::copy_n(record.history, n_history, history.begin());
        if (mirrored) {
          (record.with_solid ? system.wall_model() : system.contact_model())
              .mirror(history.data(), 2);
          record.normal.z = -record.normal.z;
        }
        record.history = history.data();
        delivery.rows.add(record);
      }
    }
  }
  return delivery;
}

void FeedBed::save(CheckpointWriter &writer) const
{
  writer.head["bed_depth"] = depth;
  Rows all;
  std::vector<std::uint32_t> keys;
  for (std::size_t k = 0; k < particles.size(); ++k) {
    const NewParticle &p = particles[k];
    std::vector<double> row = {static_cast<double>(p.id), static_cast<double>(p.type), p.radius,
                               p.mass};
    for (const Vec3 *const v : {&p.position, &p.velocity, &p.spin})
      row.insert(row.end(), {v->x, v->y, v->z});
    const Rows &contacts = rows.get_rows();
    row.insert(row.end(), contacts[k], contacts[k] + contacts.length(k));
    all.append(row.data(), row.data() + row.size());
    keys.push_back(p.id);
  }
  writer.add_rows("feed bed", keys, std::move(all));
}

void FeedBed::load(Simulation &simulation, const Checkpoint &checkpoint)
{
  const ParticleSystem &system = simulation.get_system();
  const ContactModel &model = system.contact_model();
  // Laws and solids may be others now.
  const SavedLayout layout(checkpoint.head, system.fields(), model, system.wall_model(),
                           simulation.get_solids());
  depth = number_in(checkpoint.head.at("bed_depth"));
  const Rows &all = checkpoint.rows("feed bed");
  const double n_types = model.get_materials().n_types();
  bool ok = true;
  for (std::size_t k = 0; k < all.size(); ++k)
    ok = ok && all.length(k) >= place::n_places && are_of_particle(all[k] + place::id, n_types) &&
         ContactRows::are_records(all[k] + place::n_places, all[k] + all.length(k),
                                  layout.n_history());
  checkpoint.require(ok, "its feedstock is not that of the case.");
  particles.clear();
  Rows contacts;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const double *const row = all[k];
    NewParticle p;
    p.id = static_cast<ParticleId>(row[place::id]);
    p.type = static_cast<int>(row[place::type]);
    p.radius = row[place::radius];
    p.mass = row[place::mass];
    p.position = vector_at(row + place::position);
    p.velocity = vector_at(row + place::velocity);
    p.spin = vector_at(row + place::spin);
    particles.push_back(p);
    contacts.append(row + place::n_places, row + all.length(k));
  }
  rows = ContactRows(model.history_size(), layout.translate(contacts));
  unsigned long long n = particles.size();
  MPI_Allreduce(MPI_IN_PLACE, &n, 1, MPI_UNSIGNED_LONG_LONG, MPI_SUM, simulation.communicator());
  n_global = n;
}

} // namespace eunoe::spreading
