#include "pair_kernels.h"

#include <eunoe/core/simd.h>

namespace eunoe {
namespace {

using simd::Pack;
constexpr unsigned int B = PairBlock::size;

/// A vector for each of W pairs.
template <unsigned int W>
struct Vectors
{
  Pack<W> x, y, z;
};

template <unsigned int W>
EUNOE_ALWAYS_INLINE Vectors<W> operator-(const Vectors<W> &a, const Vectors<W> &b)
{
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <unsigned int W>
EUNOE_ALWAYS_INLINE Vectors<W> operator*(const Pack<W> &s, const Vectors<W> &a)
{
  return {s * a.x, s * a.y, s * a.z};
}
template <unsigned int W>
EUNOE_ALWAYS_INLINE Pack<W> dot(const Vectors<W> &a, const Vectors<W> &b)
{
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <unsigned int W>
EUNOE_ALWAYS_INLINE Vectors<W> cross(const Vectors<W> &a, const Vectors<W> &b)
{
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// The vectors and companions of W particles.
template <unsigned int W>
EUNOE_ALWAYS_INLINE void gather(const Quad *quads, const Offset *offsets, Vectors<W> &v,
                                Pack<W> &companion)
{
  simd::gather(quads, offsets, v.x, v.y, v.z, companion);
}

template <unsigned int W>
EUNOE_ALWAYS_INLINE Pack<W> shortest(const Pack<W> &d, const double half, const double length)
{
  const Pack<W> once = d > half ? d - length : d;
  return once < -half ? once + length : once;
}

template <unsigned int W>
EUNOE_ALWAYS_INLINE Vectors<W> shortest(const Vectors<W> &d, const Period &period)
{
  return {shortest<W>(d.x, period.half.x, period.length.x),
          shortest<W>(d.y, period.half.y, period.length.y),
          shortest<W>(d.z, period.half.z, period.length.z)};
}

template <unsigned int W>
EUNOE_ALWAYS_INLINE void put(const Vectors<W> &v, double *x, double *y, double *z)
{
  simd::pack<W>(x) = v.x;
  simd::pack<W>(y) = v.y;
  simd::pack<W>(z) = v.z;
}

template <unsigned int W>
EUNOE_ALWAYS_INLINE Vectors<W> get(const double *x, const double *y, const double *z)
{
  return {simd::pack<W>(x), simd::pack<W>(y), simd::pack<W>(z)};
}

/// Collects a bit for each lane of a block, in sums of powers of two, which are exact.
template <unsigned int W>
class Bits
{
public:
  /// Bits of the next W lanes, 0 or 1 each.
  EUNOE_ALWAYS_INLINE void add(const Pack<W> &flags)
  {
    sum += weight * flags;
    weight = weight * static_cast<double>(1 << W);
  }

  EUNOE_ALWAYS_INLINE std::uint64_t take() const
  {
    double total = 0.;
    for (unsigned int l = 0; l < W; ++l)
      total += sum[l];
    return static_cast<std::uint64_t>(total);
  }

  EUNOE_ALWAYS_INLINE Bits()
  {
    for (unsigned int l = 0; l < W; ++l)
      weight[l] = static_cast<double>(1 << l);
  }

private:
  Pack<W> weight, sum = {};
};

/// Bits of a block: `half` adds those of the lanes from its parameter on, for half of a block.
template <unsigned int W, typename Half>
EUNOE_ALWAYS_INLINE std::uint64_t bits_of_block(const Half &half)
{
  std::uint64_t bits = 0;
#pragma GCC unroll 1
  for (unsigned int first = 0; first < B; first += B / 2) {
    Bits<W> part;
#pragma GCC unroll 1
    for (unsigned int k = first; k < first + B / 2; k += W)
      part.add(half(k));
    bits |= part.take() << first;
  }
  return bits;
}

/// Describes the pairs from lane @p k on.
/// @return 1 for those that are within reach, else 0
template <unsigned int W>
EUNOE_ALWAYS_INLINE Pack<W> describe(ParticleBlock &b, const ParticleArrays &p,
                                     const unsigned int k, const Period &period, const double range)
{
  const Offset *const i = b.i + k, *const j = b.j + k;
  Vectors<W> xi, xj, vi, vj, wi, wj;
  Pack<W> ri, rj, mi, mj, inertia_i, inertia_j;
  gather<W>(p.position.data(), i, xi, ri);
  gather<W>(p.position.data(), j, xj, rj);
  const Vectors<W> d = shortest(xj - xi, period);
  const Pack<W> square = dot(d, d), distance = simd::root<W>(square), sum = ri + rj;
  const Pack<W> reach = sum + range;
  const Pack<W> zero = {}, one = zero + 1.;
  const Pack<W> is_out = square - reach * reach <= 0. ? zero : one;
  // Divided, not multiplied by an inverse: a normal along an axis has length one exactly.
  const Vectors<W> n = {d.x / distance, d.y / distance, d.z / distance};
  put(n, b.nx + k, b.ny + k, b.nz + k);
  simd::pack<W>(b.is_out + k) = is_out;
  simd::pack<W>(b.distance + k) = distance;
  simd::pack<W>(b.overlap + k) = sum - distance;
  simd::pack<W>(b.radius_i + k) = ri;
  simd::pack<W>(b.radius_j + k) = rj;

  gather<W>(p.spin.data(), i, wi, inertia_i);
  gather<W>(p.spin.data(), j, wj, inertia_j);
  const Vectors<W> spin = wi - wj;
  const Pack<W> twist = dot(spin, n);
  put(spin - twist * n, b.roll_x + k, b.roll_y + k, b.roll_z + k);
  simd::pack<W>(b.twist + k) = twist;
  const Vectors<W> surface = {ri * wi.x + rj * wj.x, ri * wi.y + rj * wj.y, ri * wi.z + rj * wj.z};

  gather<W>(p.velocity.data(), i, vi, mi);
  gather<W>(p.velocity.data(), j, vj, mj);
  // One division for the three effective quantities.
  const Pack<W> masses = mi + mj, inertias = inertia_i + inertia_j;
  const Pack<W> sum_masses = sum * masses, inverse = 1. / (sum_masses * inertias);
  simd::pack<W>(b.radius + k) = ri * rj * (masses * inertias * inverse);
  simd::pack<W>(b.mass + k) = mi * mj * (sum * inertias * inverse);
  simd::pack<W>(b.inertia + k) = inertia_i * inertia_j * (sum_masses * inverse);
  const Vectors<W> turn = cross(surface, n), apart = vi - vj;
  const Vectors<W> v = {apart.x + turn.x, apart.y + turn.y, apart.z + turn.z};
  const Pack<W> closing = dot(v, n);
  simd::pack<W>(b.closing_speed + k) = closing;
  put(v - closing * n, b.slip_x + k, b.slip_y + k, b.slip_z + k);
  return one - is_out;
}

/// Adds the forces and torques of the pairs from lane @p k on; nothing of those out of reach.
template <unsigned int W>
EUNOE_ALWAYS_INLINE void add(const ParticleBlock &b, ParticleArrays &p, const unsigned int k)
{
  const Pack<W> is_out = simd::pack<W>(b.is_out + k), zero = {};
  const auto read = [&](const double *lanes) __attribute__((always_inline))
  {
    return is_out > zero ? zero : simd::pack<W>(lanes + k);
  };
  const Vectors<W> n = get<W>(b.nx + k, b.ny + k, b.nz + k),
                   shear = {read(b.shear_x), read(b.shear_y), read(b.shear_z)},
                   rolling = {read(b.torque_x), read(b.torque_y), read(b.torque_z)};
  const Pack<W> normal = read(b.contact_force) - read(b.cohesion);
  const Vectors<W> arm = cross(n, shear);
  const Pack<W> ri = simd::pack<W>(b.radius_i + k), rj = simd::pack<W>(b.radius_j + k);
  simd::Four force[W], on_i[W], on_j[W];
  simd::rows<W>(normal * n.x + shear.x, normal * n.y + shear.y, normal * n.z + shear.z, zero,
                force);
  simd::rows<W>(rolling.x - ri * arm.x, rolling.y - ri * arm.y, rolling.z - ri * arm.z, zero, on_i);
  simd::rows<W>(-rolling.x - rj * arm.x, -rolling.y - rj * arm.y, -rolling.z - rj * arm.z, zero,
                on_j);
  Quad *const forces = p.force.data(), *const torques = p.torque.data();
#pragma GCC unroll 8
  for (unsigned int l = 0; l < W; ++l) {
    const Offset i = b.i[k + l], j = b.j[k + l];
    simd::four(forces, i) -= force[l];
    simd::four(forces, j) += force[l];
    simd::four(torques, i) += on_i[l];
    simd::four(torques, j) += on_j[l];
  }
}

template <unsigned int W>
EUNOE_ALWAYS_INLINE std::uint64_t describe_by(ParticleBlock &b, const ParticleArrays &p,
                                              const Period &period, const double range)
{
  return bits_of_block<W>([&](const unsigned int k) __attribute__((always_inline)) {
    return describe<W>(b, p, k, period, range);
  });
}

EUNOE_BY_WIDTH(std::uint64_t, describe_kernel,
               (ParticleBlock & b, const ParticleArrays &p, const Period &period,
                const double range),
               describe_by, (b, p, period, range))

template <unsigned int W>
EUNOE_ALWAYS_INLINE void add_by(const ParticleBlock &b, ParticleArrays &p)
{
#pragma GCC unroll 1
  for (unsigned int k = 0; k < B; k += W)
    add<W>(b, p, k);
}

EUNOE_BY_WIDTH(void, add_kernel, (const ParticleBlock &b, ParticleArrays &p), add_by, (b, p))

template <unsigned int W>
EUNOE_ALWAYS_INLINE std::uint64_t add_and_describe_by(const ParticleBlock &last,
                                                      ParticleBlock &next, ParticleArrays &p,
                                                      const Period &period, const double range)
{
  return bits_of_block<W>([&](const unsigned int k) __attribute__((always_inline)) {
    add<W>(last, p, k);
    return describe<W>(next, p, k, period, range);
  });
}

EUNOE_BY_WIDTH(std::uint64_t, add_and_describe_kernel,
               (const ParticleBlock &last, ParticleBlock &next, ParticleArrays &p,
                const Period &period, const double range),
               add_and_describe_by, (last, next, p, period, range))

/// @param reach of the pairs from a lane on, from the sums of their radii
template <unsigned int W, typename Reach>
EUNOE_ALWAYS_INLINE std::uint64_t bits_within(const Quad *position, const Offset *i,
                                              const Offset *j, const Period &period,
                                              const Reach &reach)
{
  const Pack<W> zero = {}, one = zero + 1.;
  return bits_of_block<W>([&](const unsigned int k) __attribute__((always_inline)) {
    Vectors<W> xi, xj;
    Pack<W> ri, rj;
    gather<W>(position, i + k, xi, ri);
    gather<W>(position, j + k, xj, rj);
    const Vectors<W> d = shortest(xj - xi, period);
    const Pack<W> farthest = reach(k, ri + rj);
    return dot(d, d) - farthest * farthest <= 0. ? one : zero;
  });
}

template <unsigned int W>
EUNOE_ALWAYS_INLINE std::uint64_t within_by(const Quad *position, const Offset *i, const Offset *j,
                                            const Period &period, const double range)
{
  return bits_within<W>(
      position, i, j,
      period, [&](unsigned int, const Pack<W> &radii) __attribute__((always_inline)) {
        return radii + range;
      });
}

EUNOE_BY_WIDTH(std::uint64_t, within_kernel,
               (const Quad *position, const Offset *i, const Offset *j, const Period &period,
                const double range),
               within_by, (position, i, j, period, range))

template <unsigned int W>
EUNOE_ALWAYS_INLINE std::uint64_t within_paces_by(const ParticleArrays &p, const Offset *i,
                                                  const Offset *j, const Period &period,
                                                  const double range, const double n_paces,
                                                  const double factor)
{
  return bits_within<W>(
      p.position.data(), i, j,
      period, [&](const unsigned int k, const Pack<W> &radii) __attribute__((always_inline)) {
        Pack<W> paces;
        for (unsigned int l = 0; l < W; ++l)
          paces[l] = static_cast<double>(p.pace[row_of(i[k + l])]) +
                     static_cast<double>(p.pace[row_of(j[k + l])]);
        return factor * (radii + range + n_paces * paces);
      });
}

EUNOE_BY_WIDTH(std::uint64_t, within_paces_kernel,
               (const ParticleArrays &p, const Offset *i, const Offset *j, const Period &period,
                const double range, const double n_paces, const double factor),
               within_paces_by, (p, i, j, period, range, n_paces, factor))

EUNOE_MULTIVERSION void recall_kernel(PairBlock &block, const ContactMemory &memory,
                                      const std::int32_t *record)
{
  memory.load(block, record);
}

EUNOE_MULTIVERSION void remember_kernel(const PairBlock &block, ContactMemory &memory,
                                        const std::int32_t *record)
{
  memory.store(block, record);
}

} // namespace

std::uint64_t within(const Quad *position, const Offset *i, const Offset *j, const Period &period,
                     const double range)
{
  return within_kernel(position, i, j, period, range);
}

std::uint64_t within_paces(const ParticleArrays &p, const Offset *i, const Offset *j,
                           const Period &period, const double range, const double n_paces,
                           const double factor)
{
  return within_paces_kernel(p, i, j, period, range, n_paces, factor);
}

std::uint64_t describe(ParticleBlock &b, const ParticleArrays &p, const Period &period,
                       const double range)
{
  return describe_kernel(b, p, period, range);
}

void add(const ParticleBlock &b, ParticleArrays &p)
{
  add_kernel(b, p);
}

std::uint64_t add_and_describe(const ParticleBlock &last, ParticleBlock &next, ParticleArrays &p,
                               const Period &period, const double range)
{
  return add_and_describe_kernel(last, next, p, period, range);
}

void recall(PairBlock &b, const ContactMemory &memory, const std::int32_t *record)
{
  recall_kernel(b, memory, record);
}

void remember(const PairBlock &b, ContactMemory &memory, const std::int32_t *record)
{
  remember_kernel(b, memory, record);
}

} // namespace eunoe
