#include <eunoe/contact/pair_forces.h>
#include <eunoe/core/simd.h>

#include <algorithm>

namespace eunoe {
namespace {

constexpr unsigned int B = PairBlock::size;
using Lanes = PairBlock::Lanes;

struct Period
{
  Vec3 length, half;
};

/// Writes the components of quads[rows[0..B)] to x, y, z, w.
EUNOE_ALWAYS_INLINE void gather(const Quad *quads, const std::int32_t *rows, double *x, double *y,
                                double *z, double *w)
{
  for (unsigned int k = 0; k < B; k += 4) {
    simd::Four a = simd::four(quads[rows[k]]);
    simd::Four b = simd::four(quads[rows[k + 1]]);
    simd::Four c = simd::four(quads[rows[k + 2]]);
    simd::Four d = simd::four(quads[rows[k + 3]]);
    simd::transpose(a, b, c, d);
    simd::four(x + k) = a;
    simd::four(y + k) = b;
    simd::four(z + k) = c;
    simd::four(w + k) = d;
  }
}

/// The pairs of a list that count: all, those at some places, or those that are near.
struct Chosen
{
  const PairList &pairs;
  const std::vector<std::int32_t> *places = nullptr; ///< null: all
  bool are_near = false;                             ///< places are those of `pairs.near`

  std::size_t size() const { return places != nullptr ? places->size() : pairs.size(); }
};

/// B pairs that may be within reach; those behind the first n repeat a valid one.
struct Candidates
{
  const std::int32_t *i, *j, *record;
  std::int32_t place[B]; ///< in the list of pairs
  unsigned int n;

  /// The pairs from @p first on.
  void take(const Chosen &chosen, const std::size_t first)
  {
    n = static_cast<unsigned int>(std::min<std::size_t>(B, chosen.size() - first));
    if (n == B && chosen.places == nullptr)
      take_all(chosen.pairs, first);
    else if (n == B && chosen.are_near)
      take_near(chosen.pairs, first);
    else
      take_some(chosen, first);
  }

private:
  void take_all(const PairList &pairs, const std::size_t first)
  {
    for (unsigned int k = 0; k < B; ++k)
      place[k] = static_cast<std::int32_t>(first + k);
    i = &pairs.i[first];
    j = &pairs.j[first];
    record = &pairs.record[first];
  }

  void take_near(const PairList &pairs, const std::size_t first)
  {
    std::copy_n(&pairs.near.places[first], B, place);
    for (unsigned int k = 0; k < B; ++k)
      own_record[k] = pairs.record[place[k]];
    i = &pairs.near.i[first];
    j = &pairs.near.j[first];
    record = own_record;
  }

  void take_some(const Chosen &chosen, const std::size_t first)
  {
    for (unsigned int k = 0; k < B; ++k) {
      const std::size_t at = std::min<std::size_t>(first + k, chosen.size() - 1);
      place[k] = chosen.places != nullptr ? (*chosen.places)[at] : static_cast<std::int32_t>(at);
      own_i[k] = chosen.pairs.i[place[k]];
      own_j[k] = chosen.pairs.j[place[k]];
      own_record[k] = chosen.pairs.record[place[k]];
    }
    i = own_i;
    j = own_j;
    record = own_record;
  }

  std::int32_t own_i[B], own_j[B], own_record[B];
};

/// Squares of the distances less those of `factor` times the sum of the radii and @p range (m2).
EUNOE_ALWAYS_INLINE void compare(const Quad *position, const Candidates &candidates,
                                 const Period &period, const double range, const double factor,
                                 double *excess)
{
  alignas(64) Lanes xi, yi, zi, ri, xj, yj, zj, rj;
  gather(position, candidates.i, xi, yi, zi, ri);
  gather(position, candidates.j, xj, yj, zj, rj);
#pragma omp simd
  for (unsigned int k = 0; k < B; ++k) {
    const double dx = shortest_image(xj[k] - xi[k], period.half.x, period.length.x);
    const double dy = shortest_image(yj[k] - yi[k], period.half.y, period.length.y);
    const double dz = shortest_image(zj[k] - zi[k], period.half.z, period.length.z);
    const double reach = factor * (ri[k] + rj[k] + range);
    excess[k] = dx * dx + dy * dy + dz * dz - reach * reach;
  }
}

/// Sorts candidates into those within reach and those whose contact has ended, by their places.
/// Both outputs need room for B more entries.
EUNOE_MULTIVERSION void select(const Quad *position, const Candidates &candidates,
                               const Period &period, const double range, std::int32_t *active,
                               unsigned int &n_active, std::int32_t *ended, unsigned int &n_ended)
{
  alignas(64) Lanes excess;
  compare(position, candidates, period, range, 1., excess);
  unsigned int a = n_active, e = n_ended;
  for (unsigned int k = 0; k < candidates.n; ++k) {
    const bool within = excess[k] <= 0.;
    active[a] = candidates.place[k];
    a += within;
    ended[e] = candidates.place[k];
    e += static_cast<unsigned int>(!within) & static_cast<unsigned int>(candidates.record[k] >= 0);
  }
  n_active = a;
  n_ended = e;
}

/// Appends the candidates with a separation of up to @p margin beyond reach, and those that have a
/// contact, which may have to end.
EUNOE_MULTIVERSION void sift(const Quad *position, const Candidates &candidates,
                             const Period &period, const double margin, NearPairs &near)
{
  alignas(64) Lanes excess;
  compare(position, candidates, period, margin, 1. + NearPairs::slack, excess);
  std::size_t n = near.places.size();
  for (auto *list : {&near.places, &near.i, &near.j})
    list->resize(n + B);
  for (unsigned int k = 0; k < candidates.n; ++k) {
    near.places[n] = candidates.place[k];
    near.i[n] = candidates.i[k];
    near.j[n] = candidates.j[k];
    n += static_cast<unsigned int>(excess[k] <= 0.) |
         static_cast<unsigned int>(candidates.record[k] >= 0);
  }
  for (auto *list : {&near.places, &near.i, &near.j})
    list->resize(n);
}

/// Makes the list of near pairs anew.
void find_near(const Quad *position, const Chosen &chosen, const Period &period, const double range,
               NearPairs &near)
{
  const double margin = near.begin() + range;
  Candidates candidates;
  for (std::size_t first = 0; first < chosen.size(); first += B) {
    candidates.take(chosen, first);
    sift(position, candidates, period, margin, near);
  }
}

/// Fills in the geometry and kinematics of the pairs (i[k], j[k]).
EUNOE_MULTIVERSION void describe(PairBlock &b, const ParticleArrays &p, const std::int32_t *i,
                                 const std::int32_t *j, const Period &period, double *ri,
                                 double *rj)
{
  alignas(64) Lanes xi, yi, zi, xj, yj, zj;
  alignas(64) Lanes vxi, vyi, vzi, mi, vxj, vyj, vzj, mj;
  alignas(64) Lanes wxi, wyi, wzi, inertia_i, wxj, wyj, wzj, inertia_j;
  gather(p.position.data(), i, xi, yi, zi, ri);
  gather(p.position.data(), j, xj, yj, zj, rj);
  gather(p.velocity.data(), i, vxi, vyi, vzi, mi);
  gather(p.velocity.data(), j, vxj, vyj, vzj, mj);
  gather(p.spin.data(), i, wxi, wyi, wzi, inertia_i);
  gather(p.spin.data(), j, wxj, wyj, wzj, inertia_j);
#pragma omp simd
  for (unsigned int k = 0; k < B; ++k) {
    const double dx = shortest_image(xj[k] - xi[k], period.half.x, period.length.x);
    const double dy = shortest_image(yj[k] - yi[k], period.half.y, period.length.y);
    const double dz = shortest_image(zj[k] - zi[k], period.half.z, period.length.z);
    const double distance = std::sqrt(dx * dx + dy * dy + dz * dz);
    // Divided, not multiplied by an inverse: a normal along an axis has length one exactly.
    const double nx = dx / distance, ny = dy / distance, nz = dz / distance;
    b.nx[k] = nx;
    b.ny[k] = ny;
    b.nz[k] = nz;
    b.distance[k] = distance;
    b.overlap[k] = ri[k] + rj[k] - distance;
    b.radius[k] = ri[k] * rj[k] / (ri[k] + rj[k]);
    b.mass[k] = mi[k] * mj[k] / (mi[k] + mj[k]);
    b.inertia[k] = inertia_i[k] * inertia_j[k] / (inertia_i[k] + inertia_j[k]);

    const double sx = ri[k] * wxi[k] + rj[k] * wxj[k];
    const double sy = ri[k] * wyi[k] + rj[k] * wyj[k];
    const double sz = ri[k] * wzi[k] + rj[k] * wzj[k];
    const double vx = vxi[k] - vxj[k] + (sy * nz - sz * ny);
    const double vy = vyi[k] - vyj[k] + (sz * nx - sx * nz);
    const double vz = vzi[k] - vzj[k] + (sx * ny - sy * nx);
    const double closing = vx * nx + vy * ny + vz * nz;
    b.closing_speed[k] = closing;
    b.slip_x[k] = vx - closing * nx;
    b.slip_y[k] = vy - closing * ny;
    b.slip_z[k] = vz - closing * nz;

    const double wx = wxi[k] - wxj[k], wy = wyi[k] - wyj[k], wz = wzi[k] - wzj[k];
    const double twist = wx * nx + wy * ny + wz * nz;
    b.roll_x[k] = wx - twist * nx;
    b.roll_y[k] = wy - twist * ny;
    b.roll_z[k] = wz - twist * nz;
    b.twist[k] = twist;
  }
}

EUNOE_MULTIVERSION void recall(PairBlock &block, const ContactMemory &memory,
                               const std::int32_t *record)
{
  memory.load(block, record);
}

EUNOE_MULTIVERSION void remember(const PairBlock &block, ContactMemory &memory,
                                 const std::int32_t *record)
{
  memory.store(block, record);
}

/// Adds the block's forces and torques to both particles of every pair, pair by pair.
EUNOE_MULTIVERSION void scatter(const PairBlock &b, ParticleArrays &p, const std::int32_t *i,
                                const std::int32_t *j, const double *ri, const double *rj)
{
  alignas(64) Lanes fx, fy, fz, tix, tiy, tiz, tjx, tjy, tjz;
#pragma omp simd
  for (unsigned int k = 0; k < B; ++k) {
    const double normal = b.contact_force[k] - b.cohesion[k];
    fx[k] = normal * b.nx[k] + b.shear_x[k];
    fy[k] = normal * b.ny[k] + b.shear_y[k];
    fz[k] = normal * b.nz[k] + b.shear_z[k];
    const double cx = b.ny[k] * b.shear_z[k] - b.nz[k] * b.shear_y[k];
    const double cy = b.nz[k] * b.shear_x[k] - b.nx[k] * b.shear_z[k];
    const double cz = b.nx[k] * b.shear_y[k] - b.ny[k] * b.shear_x[k];
    tix[k] = b.torque_x[k] - ri[k] * cx;
    tiy[k] = b.torque_y[k] - ri[k] * cy;
    tiz[k] = b.torque_z[k] - ri[k] * cz;
    tjx[k] = -b.torque_x[k] - rj[k] * cx;
    tjy[k] = -b.torque_y[k] - rj[k] * cy;
    tjz[k] = -b.torque_z[k] - rj[k] * cz;
  }
  alignas(64) static const Lanes zero = {};
  const auto rows = [](const double *x, const double *y, const double *z, unsigned int k,
                       simd::Four(&out)[4]) __attribute__((always_inline))
  {
    out[0] = simd::four(x + k);
    out[1] = simd::four(y + k);
    out[2] = simd::four(z + k);
    out[3] = simd::four(zero + k);
    simd::transpose(out[0], out[1], out[2], out[3]);
  };
  Quad *const force = p.force.data(), *const torque = p.torque.data();
  for (unsigned int k = 0; k < b.n; k += 4) {
    simd::Four f[4], ti[4], tj[4];
    rows(fx, fy, fz, k, f);
    rows(tix, tiy, tiz, k, ti);
    rows(tjx, tjy, tjz, k, tj);
    const unsigned int count = b.n - k < 4 ? b.n - k : 4;
    for (unsigned int l = 0; l < count; ++l) {
      simd::four(force[i[k + l]]) -= f[l];
      simd::four(force[j[k + l]]) += f[l];
      simd::four(torque[i[k + l]]) += ti[l];
      simd::four(torque[j[k + l]]) += tj[l];
    }
  }
}

/// Walks along the list: `end(place)` is called for pairs that have a contact and are out of reach,
/// `run(places, n)` with up to B pairs within reach at a time.
template <typename End, typename Run>
void walk(const Quad *position, const Chosen &chosen, const Period &period, const double range,
          const End &end, const Run &run)
{
  std::int32_t active[2 * B], ended[2 * B];
  const std::size_t n_pairs = chosen.size();
  unsigned int n_active = 0;
  Candidates candidates;
  for (std::size_t first = 0; first < n_pairs; first += B) {
    candidates.take(chosen, first);
    unsigned int n_ended = 0;
    select(position, candidates, period, range, active, n_active, ended, n_ended);
    for (unsigned int e = 0; e < n_ended; ++e)
      end(ended[e]);
    if (n_active >= B) {
      run(active, B);
      n_active -= B;
      std::copy_n(active + B, n_active, active);
    }
  }
  if (n_active > 0)
    run(active, n_active);
}

/// The particles of a block's pairs and their radii.
struct PairRows
{
  std::int32_t i[B], j[B];
  alignas(64) Lanes ri, rj;
};

/// Fills a block with all but what the contacts remember.
void fill(PairBlock &block, PairRows &rows, const ParticleArrays &particles, const PairList &pairs,
          const std::int32_t *places, const unsigned int n, const Materials &materials,
          const Period &period)
{
  for (unsigned int k = 0; k < B; ++k) {
    const std::int32_t pair = places[std::min(k, n - 1)];
    rows.i[k] = pairs.i[pair];
    rows.j[k] = pairs.j[pair];
  }
  block.n = n;
  block.uniform_kind = materials.only_particle_kind();
  if (block.uniform_kind < 0)
    for (unsigned int k = 0; k < B; ++k)
      block.kind[k] = materials.kind(particles.type[rows.i[k]], particles.type[rows.j[k]]);
  describe(block, particles, rows.i, rows.j, period, rows.ri, rows.rj);
}

} // namespace

PairForces::PairForces(const ContactModel &model, const PeriodicBox &box)
    : model(model), box(box), block(std::make_unique<PairBlock>())
{
}

void PairForces::add(ParticleArrays &particles, PairList &pairs, const double dt)
{
  const Period period{box.length, box.half()};
  const auto end = [&pairs](const std::int32_t pair) {
    pairs.memory.release(pairs.record[pair]);
    pairs.record[pair] = ContactMemory::none;
  };
  const auto run = [&](const std::int32_t *places, const unsigned int n) {
    PairRows rows;
    alignas(64) std::int32_t record[B];
    fill(*block, rows, particles, pairs, places, n, model.get_materials(), period);
    for (unsigned int k = 0; k < B; ++k) {
      const std::int32_t pair = places[std::min(k, n - 1)];
      if (pairs.record[pair] == ContactMemory::none)
        pairs.record[pair] = pairs.memory.create();
      record[k] = pairs.record[pair];
    }
    recall(*block, pairs.memory, record);
    model.apply(*block, dt);
    scatter(*block, particles, rows.i, rows.j, rows.ri, rows.rj);
    remember(*block, pairs.memory, record);
  };
  const Quad *const position = particles.position.data();
  const Chosen awake{pairs, pairs.some_sleep ? &pairs.awake : nullptr};
  if (pairs.near.is_used() && pairs.near.is_due())
    find_near(position, awake, period, model.range(), pairs.near);
  walk(position, pairs.near.is_used() ? Chosen{pairs, &pairs.near.places, true} : awake, period,
       model.range(), end, run);
}

void PairForces::evaluate(const ParticleArrays &particles, const PairList &pairs,
                          const std::vector<std::int32_t> *places,
                          const ContactForceSink &sink) const
{
  const Period period{box.length, box.half()};
  const auto own = std::make_unique<PairBlock>();
  PairBlock &b = *own;
  const auto run = [&](const std::int32_t *active, const unsigned int n) {
    PairRows rows;
    fill(b, rows, particles, pairs, active, n, model.get_materials(), period);
    for (unsigned int k = 0; k < B; ++k) {
      const std::int32_t record = pairs.record[active[std::min(k, n - 1)]];
      for (unsigned int h = 0; h < model.history_size(); ++h)
        b.history[h][k] = record == ContactMemory::none ? 0. : pairs.memory[record][h];
    }
    model.apply(b, 0.);
    for (unsigned int k = 0; k < n; ++k)
      sink({rows.i[k],
            rows.j[k],
            -1,
            {b.nx[k], b.ny[k], b.nz[k]},
            b.distance[k],
            b.overlap[k],
            b.contact_force[k] - b.cohesion[k],
            {b.shear_x[k], b.shear_y[k], b.shear_z[k]},
            {b.torque_x[k], b.torque_y[k], b.torque_z[k]}});
  };
  walk(
      particles.position.data(), {pairs, places}, period, model.range(), [](std::int32_t) {}, run);
}

} // namespace eunoe
