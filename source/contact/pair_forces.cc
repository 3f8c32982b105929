#include <eunoe/contact/pair_forces.h>
#include <eunoe/core/simd.h>

#include "pair_kernels.h"

#include <algorithm>

namespace eunoe {
namespace {

constexpr std::size_t B = PairBlock::size;

/// Pairs of a list that may be near, a block at a time: all of them, or those at some places.
class Candidates
{
public:
  Candidates(const PairList &pairs, const std::vector<std::int32_t> *places)
      : pairs(pairs), places(places)
  {
  }

  std::size_t size() const { return places != nullptr ? places->size() : pairs.size(); }

  /// The block from @p first on; behind the first `n` the last one is repeated.
  void take(const std::size_t first)
  {
    n = static_cast<unsigned int>(std::min<std::size_t>(B, size() - first));
    for (unsigned int k = 0; k < B; ++k) {
      const std::size_t at = first + std::min(k, n - 1);
      place[k] = places != nullptr ? (*places)[at] : static_cast<std::int32_t>(at);
      i[k] = offset_of(pairs.i[place[k]]);
      j[k] = offset_of(pairs.j[place[k]]);
      record[k] = pairs.record[place[k]];
    }
  }

  unsigned int n = 0;
  std::int32_t place[B], record[B];
  Offset i[B], j[B];

private:
  const PairList &pairs;
  const std::vector<std::int32_t> *const places;
};

/// From so many particles on it pays to ask for them ahead. Those of fewer are in a near cache, and
/// asking costs more than waiting does.
constexpr std::size_t far_from = 100000;

/// Lets the processor bring into its cache what forces need of a particle. Asked again for
/// particles that are in several pairs: processors drop what they are asked for while they wait for
/// much.
void prefetch(const ParticleArrays &p, const Offset particle)
{
  for (const std::vector<Quad> *quads : {&p.position, &p.velocity, &p.spin, &p.force, &p.torque})
    __builtin_prefetch(reinterpret_cast<const char *>(quads->data()) + particle);
}

/// Appends the candidates with bits, and those that have a contact, which may have to end.
/// @param n number of near pairs so far
/// @return and after it
std::size_t append(const Candidates &candidates, const std::uint64_t bits, NearPairs &near,
                   std::size_t n)
{
  near.make_room(n + B);
  for (unsigned int k = 0; k < candidates.n; ++k) {
    near.places[n] = candidates.place[k];
    near.i[n] = candidates.i[k];
    near.j[n] = candidates.j[k];
    n += static_cast<unsigned int>(bits >> k & 1) |
         static_cast<unsigned int>(candidates.record[k] >= 0);
  }
  return n;
}

} // namespace

/// Runs blocks of pairs one after the other. The forces of a block are added while the next one is
/// described.
class PairForces::Run
{
public:
  Run(const PairForces &forces, ParticleArrays &particles, const double dt)
      : model(forces.model), particles(particles), period(forces.box), dt(dt),
        blocks(forces.blocks.get())
  {
  }

  /// The block that is to be filled next.
  ParticleBlock &block() { return blocks[n_blocks % 2]; }

  /// Describes the block; its first @p n places count.
  /// @return bits of the pairs within reach
  std::uint64_t describe(const unsigned int n)
  {
    ParticleBlock &b = block();
    b.n = n;
    b.uniform_kind = model.get_materials().only_particle_kind();
    const std::uint64_t bits = n_blocks == 0 ? eunoe::describe(b, particles, period, model.range())
                                             : add_and_describe(blocks[(n_blocks - 1) % 2], b,
                                                                particles, period, model.range());
    for (unsigned int k = n; k < B; ++k)
      b.is_out[k] = 1.;
    return bits;
  }

  /// Runs the laws on the block.
  void apply()
  {
    model.apply(block(), dt);
    ++n_blocks;
  }

  void end()
  {
    if (n_blocks > 0)
      eunoe::add(blocks[(n_blocks - 1) % 2], particles);
  }

private:
  const ContactModel &model;
  ParticleArrays &particles;
  const Period period;
  const double dt;
  ParticleBlock *const blocks;
  std::size_t n_blocks = 0;
};

PairForces::PairForces(const ContactModel &model, const PeriodicBox &box)
    : model(model), box(box), blocks(std::make_unique<ParticleBlock[]>(2))
{
}

PairForces::~PairForces() = default;

void PairForces::list_near(ParticleArrays &particles, PairList &pairs, const double dt) const
{
  const Period period(box);
  NearPairs &near = pairs.near;
  const double n_paces = near.begin();
  for (std::size_t row = 0; row < particles.size(); ++row)
    particles.pace[row] = static_cast<float>(near.pace(dt * norm(particles.velocity[row].vec())));
  Candidates candidates(pairs, pairs.some_sleep ? &pairs.awake : nullptr);
  std::size_t n = 0;
  for (std::size_t first = 0; first < candidates.size(); first += B) {
    candidates.take(first);
    const std::uint64_t bits = within_paces(particles, candidates.i, candidates.j, period,
                                            model.range(), n_paces, 1. + NearPairs::slack);
    n = append(candidates, bits, near, n);
  }
  near.end(n);
  pairs.lay_out_memory();
  const Materials &materials = model.get_materials();
  near.kind.clear();
  if (materials.only_particle_kind() >= 0)
    return;
  for (std::size_t k = 0; k < near.n_blocks() * B; ++k) {
    const std::int32_t pair = near.places[std::min(k, n - 1)];
    near.kind.push_back(
        materials.kind(particles.type[pairs.i[pair]], particles.type[pairs.j[pair]]));
  }
}

void PairForces::add_of_all(ParticleArrays &particles, PairList &pairs, const double dt) const
{
  NearPairs &near = pairs.near;
  const bool are_far = particles.size() >= far_from;
  Run run(*this, particles, dt);
  for (std::size_t k = 0; k < near.n_blocks(); ++k) {
    const std::size_t first = k * B;
    ParticleBlock &b = run.block();
    b.i = &near.i[first];
    b.j = &near.j[first];
    b.kind = near.kind.empty() ? nullptr : &near.kind[first];
    b.history = pairs.memory.lanes.block(k);
    pairs.note_reach(k, run.describe(static_cast<unsigned int>(std::min(B, near.size() - first))));
    if (are_far && k + 1 < near.n_blocks()) {
      pairs.memory.lanes.prefetch(k + 1);
      for (std::size_t next = first + B; next < first + 2 * B; ++next)
        for (const Offset particle : {near.i[next], near.j[next]})
          prefetch(particles, particle);
    }
    run.apply();
  }
  run.end();
}

void PairForces::add_of_some(ParticleArrays &particles, PairList &pairs, const double dt) const
{
  const Period period(box);
  NearPairs &near = pairs.near;
  const bool are_far = particles.size() >= far_from;
  Run run(*this, particles, dt);
  std::int32_t place[2 * B];
  alignas(64) std::int32_t record[B];
  const auto run_block = [&](const unsigned int n) {
    ParticleBlock &b = run.block();
    b.i = b.own_i;
    b.j = b.own_j;
    b.kind = b.own_kind;
    b.history = b.own_history;
    for (unsigned int k = 0; k < B; ++k) {
      const std::int32_t at = place[std::min(k, n - 1)];
      b.own_i[k] = near.i[at];
      b.own_j[k] = near.j[at];
      if (!near.kind.empty())
        b.own_kind[k] = near.kind[at];
      record[k] = PairMemory::number_in_pool(pairs.record[near.places[at]]);
    }
    recall(b, pairs.memory.pool, record);
    run.describe(n);
    run.apply();
    remember(b, pairs.memory.pool, record);
  };
  unsigned int n = 0;
  for (std::size_t k = 0; k < near.n_blocks(); ++k) {
    const std::size_t first = k * B;
    pairs.note_reach(k, within(particles.position.data(), &near.i[first], &near.j[first], period,
                               model.range()));
    for (std::uint64_t bits = near.in_reach[k]; bits != 0; bits &= bits - 1) {
      const std::int32_t at = static_cast<std::int32_t>(first) + __builtin_ctzll(bits);
      if (are_far)
        for (const Offset particle : {near.i[at], near.j[at]})
          prefetch(particles, particle);
      place[n++] = at;
    }
    if (n < B)
      continue;
    run_block(B);
    n -= B;
    std::copy_n(place + B, n, place);
  }
  if (n > 0)
    run_block(n);
  run.end();
}

void PairForces::add(ParticleArrays &particles, PairList &pairs, const double dt)
{
  if (pairs.near.is_due())
    list_near(particles, pairs, dt);
  if (pairs.near.is_dense())
    add_of_all(particles, pairs, dt);
  else
    add_of_some(particles, pairs, dt);
}

void PairForces::evaluate(const ParticleArrays &particles, const PairList &pairs,
                          const std::vector<std::int32_t> *places,
                          const ContactForceSink &sink) const
{
  const Period period(box);
  const auto own = std::make_unique<ParticleBlock>();
  ParticleBlock &b = *own;
  Candidates candidates(pairs, places);
  b.i = candidates.i;
  b.j = candidates.j;
  const Materials &materials = model.get_materials();
  b.uniform_kind = materials.only_particle_kind();
  for (std::size_t first = 0; first < candidates.size(); first += B) {
    candidates.take(first);
    b.n = candidates.n;
    for (unsigned int k = 0; k < B; ++k) {
      const std::int32_t pair = candidates.place[k], record = candidates.record[k];
      b.own_kind[k] = materials.kind(particles.type[pairs.i[pair]], particles.type[pairs.j[pair]]);
      double remembered[PairBlock::max_history] = {};
      if (record != ContactMemory::none)
        pairs.memory.read(record, remembered);
      for (unsigned int h = 0; h < model.history_size(); ++h)
        b.history[h][k] = remembered[h];
    }
    describe(b, particles, period, model.range());
    model.apply(b, 0.);
    for (unsigned int k = 0; k < b.n; ++k)
      if (b.is_out[k] == 0.)
        sink({pairs.i[candidates.place[k]],
              pairs.j[candidates.place[k]],
              -1,
              {b.nx[k], b.ny[k], b.nz[k]},
              b.distance[k],
              b.overlap[k],
              b.contact_force[k] - b.cohesion[k],
              {b.shear_x[k], b.shear_y[k], b.shear_z[k]},
              {b.torque_x[k], b.torque_y[k], b.torque_z[k]}});
  }
}

} // namespace eunoe
