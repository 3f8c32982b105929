#include <eunoe/engine/solid_contacts.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace eunoe {
namespace {

/// Between the normals of a contact at two steps, below which it is another one.
constexpr double least_cosine = 0.9;

/// Velocity of a solid's surface where its normal is @p n.
Vec3 surface_velocity(const Solid &solid, const Vec3 &point, const Vec3 &n)
{
  const Vec3 v = solid.state.velocity_at(point);
  // The facets of a drum that turns in place approach nobody, although w x r has a part along n.
  return solid.motion->slides_in_place() ? v - dot(v, n) * n : v;
}

} // namespace

SolidContacts::SolidContacts(const ContactModel &model)
    : model(model), batch(std::make_unique<Batch>())
{
  memory.clear(model.history_size());
}

void SolidContacts::search(const ParticleArrays &particles, const std::vector<Solid> &solids,
                           const double reach)
{
  candidates.clear();
  facets.clear();
  planes.clear();
  normals.clear();
  memory.clear(model.history_size());
  std::vector<Box> boxes;
  solids_at_search.clear();
  for (const Solid &solid : solids) {
    boxes.push_back(solid.shape->bounding_box());
    solids_at_search.push_back(solid.state);
  }
  for (std::size_t p = 0; p < particles.n_owned; ++p)
    for (std::size_t s = 0; s < solids.size(); ++s) {
      const Vec3 centre = solids[s].to_own_frame(particles.reference[p]);
      const double near = particles.radius(p) + reach;
      if (!boxes[s].contains(centre, near))
        continue;
      Candidate candidate;
      candidate.particle = static_cast<std::int32_t>(p);
      candidate.solid = static_cast<std::int32_t>(s);
      candidate.first_facet = static_cast<std::int32_t>(facets.size());
      const double separation =
          solids[s].shape->find_facets(centre, near, facets) - particles.radius(p);
      candidate.separation =
          std::nextafter(static_cast<float>(separation), -std::numeric_limits<float>::max());
      candidate.n_facets = static_cast<std::int32_t>(facets.size()) - candidate.first_facet;
      if (candidate.n_facets == 0)
        continue;
      const std::int32_t *const first = facets.data() + candidate.first_facet;
      Plane plane;
      candidate.plane = -1;
      if (solids[s].shape->is_plane(centre, near, first, first + candidate.n_facets, plane)) {
        candidate.plane = static_cast<std::int32_t>(planes.size());
        planes.push_back(plane);
      }
      candidates.push_back(candidate);
    }
}

void SolidContacts::leave_out(const Remaining &remaining)
{
  for (Candidate &candidate : candidates)
    candidate.particle = remaining[candidate.particle];
  candidates.erase(std::remove_if(candidates.begin(), candidates.end(),
                                  [](const Candidate &candidate) {
                                    return candidate.particle == Remaining::none;
                                  }),
                   candidates.end());
}

void SolidContacts::search_again(const ParticleArrays &particles, const std::vector<Solid> &solids,
                                 const double reach)
{
  const std::vector<Candidate> before = std::move(candidates);
  const std::vector<Vec3> normals_before = std::move(normals);
  const ContactMemory memory_before = std::move(memory);
  search(particles, solids, reach);
  for (const Candidate &candidate : before)
    for (unsigned int l = 0; l < candidate.n_living; ++l)
      restore(candidate.particle, candidate.solid, normals_before[candidate.living[l]],
              memory_before[candidate.living[l]]);
}

std::int32_t SolidContacts::create(const Vec3 &normal)
{
  const std::int32_t record = memory.create();
  if (static_cast<std::size_t>(record) >= normals.size())
    normals.resize(record + 1);
  normals[record] = normal;
  return record;
}

unsigned int SolidContacts::find(const Candidate &candidate, const Solid &solid,
                                 const Vec3 &position, const double radius,
                                 SurfaceContact *found) const
{
  const Vec3 centre = solid.to_own_frame(position);
  const double reach = radius + model.range();
  if (candidate.plane >= 0) {
    const Plane &plane = planes[candidate.plane];
    const double height = dot(plane.normal, centre) - plane.offset;
    found[0] = {height < 0. ? plane.normal : -plane.normal, std::abs(height)};
    return found[0].distance < reach ? 1 : 0;
  }
  const std::int32_t *const first = facets.data() + candidate.first_facet;
  return solid.shape->find_contacts(centre, radius, reach, first, first + candidate.n_facets,
                                    found);
}

double SolidContacts::deepest_overlap(const Candidate &candidate, const Solid &solid,
                                      const Vec3 &centre, const double radius) const
{
  std::array<SurfaceContact, Shape::max_contacts> found;
  const unsigned int n = find(candidate, solid, centre, radius, found.data());
  double deepest = -model.range();
  for (unsigned int k = 0; k < n; ++k)
    deepest = std::max(deepest, radius - found[k].distance);
  return deepest;
}

void SolidContacts::forget()
{
  for (Candidate &candidate : candidates)
    candidate.n_living = 0;
  memory.clear(model.history_size());
  normals.clear();
}

void SolidContacts::restore(const std::int32_t particle, const std::int32_t solid,
                            const Vec3 &normal, const double *history)
{
  const auto it = std::lower_bound(
      candidates.begin(), candidates.end(), std::pair(particle, solid),
      [](const Candidate &c, const auto &key) { return std::pair(c.particle, c.solid) < key; });
  if (it == candidates.end() || it->particle != particle || it->solid != solid ||
      it->n_living == Shape::max_contacts)
    return;
  const std::int32_t record = create(normal);
  std::copy_n(history, model.history_size(), memory[record]);
  it->living[it->n_living++] = record;
}

std::int32_t SolidContacts::take_living(Candidate &candidate, const Vec3 &normal) const
{
  unsigned int best = candidate.n_living;
  double best_cosine = least_cosine;
  for (unsigned int l = 0; l < candidate.n_living; ++l) {
    const double cosine = candidate.living[l] == ContactMemory::none
                              ? -1.
                              : dot(normal, normals[candidate.living[l]]);
    if (cosine > best_cosine) {
      best = l;
      best_cosine = cosine;
    }
  }
  return best < candidate.n_living ? std::exchange(candidate.living[best], ContactMemory::none)
                                   : ContactMemory::none;
}

void SolidContacts::go_on(Candidate &candidate, const SurfaceContact *found,
                          const unsigned int n_found)
{
  if (n_found == 0 && candidate.n_living == 0)
    return;
  // The usual case: one contact, which goes on.
  if (n_found == 1 && candidate.n_living == 1 &&
      dot(found[0].normal, normals[candidate.living[0]]) > least_cosine)
  {
    normals[candidate.living[0]] = found[0].normal;
    return;
  }
  std::array<std::int32_t, Shape::max_contacts> living = {};
  for (unsigned int k = 0; k < n_found; ++k) {
    living[k] = take_living(candidate, found[k].normal);
    if (living[k] == ContactMemory::none)
      living[k] = create(found[k].normal);
    else
      normals[living[k]] = found[k].normal;
  }
  for (unsigned int l = 0; l < candidate.n_living; ++l)
    if (candidate.living[l] != ContactMemory::none)
      memory.release(candidate.living[l]);
  candidate.living = living;
  candidate.n_living = n_found;
}

std::vector<double> SolidContacts::ways(const std::vector<Solid> &solids) const
{
  std::vector<double> way;
  for (std::size_t s = 0; s < solids.size(); ++s)
    way.push_back(displacement(solids[s], solids_at_search[s], solids[s].state));
  return way;
}

bool SolidContacts::is_far(const Candidate &candidate, const ParticleArrays &particles,
                           const double way) const
{
  // No contact as long as both together have moved by less than their separation at the search.
  const double spare = candidate.separation - model.range() - way;
  return spare > 0. && candidate.n_living == 0 &&
         norm_square(particles.position[candidate.particle].vec() -
                     particles.reference[candidate.particle]) < spare * spare;
}

void SolidContacts::add_forces(ParticleArrays &particles, const std::vector<Solid> &solids,
                               const double time, const double dt, std::vector<SolidLoad> *loads)
{
  const std::vector<double> way = ways(solids);
  std::array<SurfaceContact, Shape::max_contacts> found;
  Candidate asleep = {}; // a copy, from which contacts may be taken
  batch->n = 0;
  for (Candidate &candidate : candidates) {
    // Sleepers also load the solids; computing that must not change the sleepers' state.
    const bool is_awake = particles.is_awake(candidate.particle);
    if ((loads == nullptr && !is_awake) || is_far(candidate, particles, way[candidate.solid]))
      continue;
    const Solid &solid = solids[candidate.solid];
    const Vec3 position = particles.position[candidate.particle].vec();
    const double radius = particles.radius(candidate.particle);
    const unsigned int n_found =
        solid.is_active(time) ? find(candidate, solid, position, radius, found.data()) : 0;
    if (is_awake)
      go_on(candidate, found.data(), n_found);
    else
      asleep = candidate;
    for (unsigned int k = 0; k < n_found; ++k) {
      const std::int32_t record =
          is_awake ? candidate.living[k] : take_living(asleep, found[k].normal);
      add_to(*batch, particles, solid, candidate, found[k], record);
      if (!is_awake)
        batch->record[batch->n - 1] = ContactMemory::none;
      if (batch->n == PairBlock::size)
        finish(particles, solids, dt, loads);
    }
  }
  if (batch->n > 0)
    finish(particles, solids, dt, loads);
}

void SolidContacts::evaluate(const ParticleArrays &particles, const std::vector<Solid> &solids,
                             const double time, const ContactForceSink &sink) const
{
  const std::vector<double> way = ways(solids);
  const auto own = std::make_unique<Batch>();
  const auto give = [&] {
    apply_laws(*own, 0.);
    for (unsigned int k = 0; k < own->n; ++k)
      sink(force_of(*own, k));
    own->n = 0;
  };
  std::array<SurfaceContact, Shape::max_contacts> found;
  for (Candidate candidate : candidates) { // copies, from which contacts may be taken
    const Solid &solid = solids[candidate.solid];
    if (!solid.is_active(time) || is_far(candidate, particles, way[candidate.solid]))
      continue;
    const unsigned int n_found =
        find(candidate, solid, particles.position[candidate.particle].vec(),
             particles.radius(candidate.particle), found.data());
    for (unsigned int k = 0; k < n_found; ++k) {
      add_to(*own, particles, solid, candidate, found[k], take_living(candidate, found[k].normal));
      if (own->n == PairBlock::size)
        give();
    }
  }
  if (own->n > 0)
    give();
}

void SolidContacts::add_to(Batch &b, const ParticleArrays &particles, const Solid &solid,
                           const Candidate &candidate, const SurfaceContact &contact,
                           const std::int32_t record) const
{
  const unsigned int k = b.n++;
  const std::int32_t p = candidate.particle;
  const Quad &position = particles.position[p], &velocity = particles.velocity[p],
             &spin = particles.spin[p];
  const double radius = particles.radius(p);
  const Vec3 n = solid.to_space(contact.normal);
  const Vec3 point = position.vec() + contact.distance * n;
  const Vec3 v = velocity.vec() - surface_velocity(solid, point, n) + cross(radius * spin.vec(), n);
  const double closing = dot(v, n);
  const Vec3 slip = v - closing * n;
  const Vec3 w = spin.vec() - solid.state.angular_velocity;
  const double twist = dot(w, n);
  const Vec3 roll = w - twist * n;

  b.nx[k] = n.x;
  b.ny[k] = n.y;
  b.nz[k] = n.z;
  b.distance[k] = contact.distance;
  b.overlap[k] = radius - contact.distance;
  b.radius[k] = radius;
  b.mass[k] = particles.mass(p);
  b.inertia[k] = particles.moment_of_inertia(p);
  b.closing_speed[k] = closing;
  b.slip_x[k] = slip.x;
  b.slip_y[k] = slip.y;
  b.slip_z[k] = slip.z;
  b.roll_x[k] = roll.x;
  b.roll_y[k] = roll.y;
  b.roll_z[k] = roll.z;
  b.twist[k] = twist;
  b.own_kind[k] = model.get_materials().kind(particles.type[p], solid.material);
  const double *const history = record == ContactMemory::none ? nullptr : memory[record];
  for (unsigned int h = 0; h < model.history_size(); ++h)
    b.history[h][k] = history == nullptr ? 0. : history[h];

  b.particle[k] = p;
  b.solid[k] = candidate.solid;
  b.record[k] = record;
  b.point[k] = point;
}

void SolidContacts::apply_laws(Batch &b, const double dt) const
{
  for (unsigned int k = b.n; k < PairBlock::size; ++k) {
    for (double *lanes :
         {b.nx, b.ny, b.nz, b.distance, b.overlap, b.radius, b.mass, b.inertia, b.closing_speed,
          b.slip_x, b.slip_y, b.slip_z, b.roll_x, b.roll_y, b.roll_z, b.twist})
      lanes[k] = lanes[b.n - 1];
    b.own_kind[k] = b.own_kind[b.n - 1];
    for (unsigned int h = 0; h < model.history_size(); ++h)
      b.history[h][k] = b.history[h][b.n - 1];
  }
  b.uniform_kind = std::all_of(b.kind, b.kind + b.n, [&b](auto kind) { return kind == b.kind[0]; })
                       ? static_cast<int>(b.kind[0])
                       : -1;
  model.apply(b, dt);
}

ContactForce SolidContacts::force_of(const Batch &b, const unsigned int k)
{
  return {b.particle[k],
          -1,
          b.solid[k],
          {b.nx[k], b.ny[k], b.nz[k]},
          b.distance[k],
          b.overlap[k],
          b.contact_force[k] - b.cohesion[k],
          {b.shear_x[k], b.shear_y[k], b.shear_z[k]},
          {b.torque_x[k], b.torque_y[k], b.torque_z[k]}};
}

void SolidContacts::finish(ParticleArrays &particles, const std::vector<Solid> &solids,
                           const double dt, std::vector<SolidLoad> *loads)
{
  Batch &b = *batch;
  apply_laws(b, dt);
  for (unsigned int k = 0; k < b.n; ++k) {
    const ContactForce contact = force_of(b, k);
    const Vec3 force = contact.force();
    if (loads != nullptr)
      (*loads)[contact.solid].add(force,
                                  cross(b.point[k] - solids[contact.solid].state.centre, force) -
                                      contact.rolling_torque);
    if (b.record[k] == ContactMemory::none)
      continue;
    const std::int32_t p = contact.first;
    particles.force[p].add(-force);
    particles.torque[p].add(contact.torque_on_first(particles.radius(p)));
    double *const history = memory[b.record[k]];
    for (unsigned int h = 0; h < model.history_size(); ++h)
      history[h] = b.history[h][k];
  }
  b.n = 0;
}

} // namespace eunoe
