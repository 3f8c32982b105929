// Contact forces that are only evaluated equal those of the step, to the last bit, for contacts
// with a memory and for those that have just begun.
// Reference: the forces that PairForces adds to the particles.

#include <eunoe/contact/pair_forces.h>
#include <eunoe/core/random.h>

#include "../tests.h"

#include <limits>

using namespace test;

namespace {

constexpr std::size_t n = 150; // more than two blocks
constexpr double radius = 1e-3, mass = 1e-6;

double draw(std::size_t row, unsigned int component)
{
  return uniform(1, Draw::size, row, component) - 0.5;
}

/// Spheres in a row, each of which touches the next; every tenth lies above the row.
ParticleArrays row_of_spheres()
{
  ParticleArrays p;
  p.resize(n, 0, 0);
  for (std::size_t k = 0; k < n; ++k) {
    const double x = 1.98 * radius * static_cast<double>(k);
    p.position[k] = {x, 1e-4 * draw(k, 0), k % 10 == 9 ? 5e-4 : 1e-4 * draw(k, 1), radius};
    p.velocity[k] = {draw(k, 2), draw(k, 3), draw(k, 4), mass};
    p.spin[k] = {50. * draw(k, 5), 50. * draw(k, 6), 50. * draw(k, 7),
                 0.4 * mass * radius * radius};
    p.id[k] = static_cast<ParticleId>(k);
  }
  return p;
}

/// Adds the forces and torques of a single contact to its particles.
void add_up(const ContactForce &contact, ParticleArrays &p)
{
  p.force[contact.first].add(-contact.force());
  p.force[contact.second].add(contact.force());
  p.torque[contact.first].add(contact.torque_on_first(radius));
  p.torque[contact.second].add(contact.torque_on_second(radius));
}

bool same(const std::vector<Quad> &a, const std::vector<Quad> &b)
{
  for (std::size_t k = 0; k < n; ++k)
    if (!(a[k].vec() == b[k].vec()))
      return false;
  return true;
}

void clear(ParticleArrays &p)
{
  p.force.assign(n, Quad());
  p.torque.assign(n, Quad());
}

} // namespace

EUNOE_MPI_TEST()
{
  ContactModelNames names;
  names.cohesion = {"dmt"};
  names.rolling = "epsd";
  Material material;
  material.friction = 0.3;
  material.surface_energy = 1e-3;
  const ContactModel model(Materials({material}, 1), names, ContactLawSections(), radius);
  PairForces forces(model, PeriodicBox());

  ParticleArrays p = row_of_spheres();
  PairList pairs;
  pairs.clear(model.history_size());
  for (std::int32_t k = 0; k + 1 < static_cast<std::int32_t>(n); ++k) {
    const std::int32_t next = k + 1;
    pairs.append(&k, &next, 1);
  }
  for (unsigned int step = 0; step < 10; ++step)
    forces.add(p, pairs, 1e-6);
  std::size_t n_before = 0, n_after = 0;
  for (const std::int32_t record : pairs.record)
    n_before += record == ContactMemory::none ? 0 : 1;
  // The spheres that lay above the row now touch it, and other contacts end.
  for (std::size_t k = 0; k < n; ++k)
    if (k % 10 == 9)
      p.position[k].z = 0.;
    else if (k % 10 == 5)
      p.position[k].z = 5e-4;
  pairs.near.note_step(Travel::unknown, Travel::unknown, radius, pairs.near.share());

  ParticleArrays evaluated = p;
  clear(evaluated);
  forces.evaluate(p, pairs, nullptr, [&](const ContactForce &c) {
    ++n_after;
    add_up(c, evaluated);
  });
  ParticleArrays part = p;
  clear(part);
  const std::vector<std::int32_t> places = {3, 8, 9, 30, 148};
  std::vector<std::int32_t> seen;
  forces.evaluate(p, pairs, &places, [&](const ContactForce &c) {
    seen.push_back(c.first);
    add_up(c, part);
  });

  PairList stepped_pairs = pairs;
  clear(p);
  forces.add(p, stepped_pairs, 0.);
  std::size_t n_begun = 0, n_ended = 0;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    n_begun += pairs.record[k] == ContactMemory::none && stepped_pairs.record[k] >= 0 ? 1 : 0;
    n_ended += pairs.record[k] >= 0 && stepped_pairs.record[k] == ContactMemory::none ? 1 : 0;
  }
  check("contacts of all kinds", n_begun > 0 && n_ended > 0 && n_before > 64 && n_after > 64);
  check("forces", same(evaluated.force, p.force));
  check("torques", same(evaluated.torque, p.torque));
  check("only those that are asked for", seen == std::vector<std::int32_t>({3, 8, 9, 30, 148}));
  check("their forces do not depend on the others",
        part.force[149].vec() == p.force[149].vec() && norm(p.force[149].vec()) > 0.);
}
