// Forces of near pairs alone equal those of the whole list, to the last bit, while particles fly
// through each other, touch and part.
// Reference: a list of near pairs that is made anew from the whole list in every step.

#include <eunoe/contact/pair_forces.h>
#include <eunoe/core/random.h>

#include "../tests.h"

#include <cmath>

using namespace test;

namespace {

constexpr std::size_t n = 300;
constexpr double radius = 1e-3, mass = 1e-6, box = 0.03, dt = 3e-5;

double draw(std::size_t row, unsigned int component)
{
  return uniform(1, Draw::size, row, component) - 0.5;
}

ParticleArrays cloud()
{
  ParticleArrays p;
  p.resize(n, 0, 0);
  for (std::size_t k = 0; k < n; ++k) {
    p.position[k] = {box * draw(k, 0), box * draw(k, 1), box * draw(k, 2), radius};
    p.velocity[k] = {draw(k, 3), draw(k, 4), draw(k, 5), mass};
    p.spin[k] = {50. * draw(k, 6), 50. * draw(k, 7), 50. * draw(k, 8),
                 0.4 * mass * radius * radius};
    p.id[k] = static_cast<ParticleId>(k);
  }
  return p;
}

PairList all_pairs(const ContactModel &model)
{
  PairList pairs;
  pairs.clear(model.history_size());
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(n); ++i)
    for (std::int32_t j = i + 1; j < static_cast<std::int32_t>(n); ++j)
      pairs.append(&i, &j, 1);
  return pairs;
}

/// Moves the particles by a step; some become faster on the way.
Travel move(ParticleArrays &p, const unsigned int step)
{
  Travel travel = {0., 0., 0.};
  for (std::size_t k = 0; k < n; ++k) {
    if (k % 50 == 0 && step == 100)
      p.velocity[k].add(4. * p.velocity[k].vec());
    const Vec3 way = dt * p.velocity[k].vec();
    p.position[k].add(way);
    const double step2 = norm_square(way), pace = p.pace[k];
    travel.paces2 = std::max(travel.paces2, step2 / (pace * pace));
    travel.mean_step2 += step2 / n;
    p.force[k] = p.torque[k] = Quad();
  }
  return travel;
}

bool same(const std::vector<Quad> &a, const std::vector<Quad> &b)
{
  for (std::size_t k = 0; k < n; ++k)
    if (!(a[k].vec() == b[k].vec()))
      return false;
  return true;
}

/// @param skin separation up to which the list is taken to have pairs (m): the larger, the longer a
///             list of near pairs lasts, and the fewer of its pairs touch
void check_flight(const std::string &name, const double skin, const bool is_dense)
{
  ContactModelNames names;
  names.rolling = "epsd";
  Material material;
  material.friction = 0.3;
  const ContactModel model(Materials({material}, 1), names, ContactLawSections(), radius);
  PairForces of_all(model, PeriodicBox()), of_near(model, PeriodicBox());
  ParticleArrays p = cloud(), whole = p; // whose paces are of a list of their own
  PairList all = all_pairs(model), near = all;

  bool forces = true, memory = true;
  unsigned int n_lists = 0, n_ended = 0;
  double longest = 0.;
  for (unsigned int step = 0; step < 400; ++step) {
    // Something is left out of account for a while, as after an insertion.
    const Travel travel = move(p, step);
    near.near.note_step(std::sqrt(travel.paces2), std::sqrt(travel.mean_step2), skin,
                        near.near.share());
    all.near.forget();
    if (step % 150 == 149)
      near.near.forget();
    n_lists += near.near.is_due() ? 1 : 0;
    const std::vector<std::int32_t> before = all.record;
    whole.position = p.position;
    whole.velocity = p.velocity;
    whole.force = p.force;
    whole.torque = p.torque;
    of_all.add(whole, all, dt);
    of_near.add(p, near, dt);
    forces = forces && same(whole.force, p.force) && same(whole.torque, p.torque);
    for (std::size_t k = 0; k < all.size(); ++k) {
      memory = memory && (all.record[k] >= 0) == (near.record[k] >= 0);
      n_ended += before[k] >= 0 && all.record[k] == ContactMemory::none ? 1 : 0;
    }
    longest = std::max(longest, static_cast<double>(near.near.size()));
  }
  check(name + ": contacts come and go", n_ended > 50);
  check(name + ": the way along the pairs", near.near.is_dense() == is_dense);
  check(name + ": few pairs are near", longest < 0.1 * static_cast<double>(all.size()));
  check(name + ": a list lasts for some steps", n_lists > 5 && n_lists < 200);
  check(name + ": forces and torques", forces);
  check(name + ": the same contacts are known", memory);
}

} // namespace

EUNOE_MPI_TEST()
{
  check_flight("dense", 2. * radius, true);
  check_flight("sparse", 100. * radius, false);

  NearPairs unknown;
  unknown.note_step(Travel::unknown, Travel::unknown, radius, unknown.share());
  check("a list lasts for no step if steps are not known",
        unknown.begin() == 0. && std::isfinite(unknown.pace(0.)));
  unknown.note_step(0., 0., radius, unknown.share());
  check("and for ever at rest", unknown.begin() == 200. && !unknown.is_due());
  check("where the slowest pace is not zero", unknown.pace(0.) > 0.);
  unknown.note_step(200.1, 0.1 * radius, radius, unknown.share());
  check("but not when something is fast", unknown.is_due());
  check("what is slower than others has their pace", unknown.pace(0.) == 0.1 * radius);
  check("what is faster has its own", unknown.pace(radius) == radius);
}
