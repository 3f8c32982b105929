#include <eunoe/core/simd.h>
#include <eunoe/engine/integrator.h>

#include <algorithm>

namespace eunoe {
namespace {

/// In x, y and z, for vectors whose w is something else.
EUNOE_ALWAYS_INLINE simd::Four three(const double s)
{
  return simd::Four{s, s, s, 0.};
}

/// dt over mass and moment of inertia, in one division.
/// @param v,w with them as last components
EUNOE_ALWAYS_INLINE simd::Two over_inertia(const double dt, const simd::Four &v,
                                           const simd::Four &w)
{
  return simd::Two{dt, dt} / simd::Two{v[3], w[3]};
}

/// Adds a force times dt / m once, or twice with a rounding between.
template <bool twice>
EUNOE_ALWAYS_INLINE simd::Four kicked(simd::Four velocity, const simd::Four &force,
                                      const double dt_over_m)
{
  const simd::Four change = three(dt_over_m) * force;
  velocity += change;
  if (twice)
    velocity += change;
  return velocity;
}

EUNOE_MULTIVERSION void half_kick(ParticleArrays &p, const double half_dt)
{
  p.for_each_awake([&](const std::size_t k) {
    simd::Four &v = simd::four(p.velocity[k]), &w = simd::four(p.spin[k]);
    const simd::Two factors = over_inertia(half_dt, v, w);
    v = kicked<false>(v, simd::four(p.force[k]), factors[0]);
    w = kicked<false>(w, simd::four(p.torque[k]), factors[1]);
  });
}

template <bool twice>
EUNOE_ALWAYS_INLINE Travel kick_and_drift(ParticleArrays &p, const double dt)
{
  const double half_dt = 0.5 * dt;
  // A maximum ignores NaN; this sum does not.
  TwoLargest farthest2;
  double poison = 0., most_paces2 = 0., sum_step2 = 0.;
  const simd::Four time = three(dt);
  const simd::Four gravity = {p.gravity.x, p.gravity.y, p.gravity.z, 0.};
  p.for_each_awake([&](const std::size_t k) {
    simd::Four &force = simd::four(p.force[k]), &torque = simd::four(p.torque[k]);
    const simd::Two factors =
        over_inertia(half_dt, simd::four(p.velocity[k]), simd::four(p.spin[k]));
    const simd::Four v = kicked<twice>(simd::four(p.velocity[k]), force, factors[0]);
    const simd::Four w = kicked<twice>(simd::four(p.spin[k]), torque, factors[1]);
    const simd::Four way = time * v, x = simd::four(p.position[k]) + way;
    const Vec3 &from = p.reference[k];
    simd::four(p.velocity[k]) = v;
    simd::four(p.spin[k]) = w;
    simd::four(p.position[k]) = x;
    // As ParticleArrays::start_forces does.
    force = simd::Four{} + three(v[3]) * gravity;
    torque = simd::Four{};
    const double moved2 = norm_square(Vec3{x[0] - from.x, x[1] - from.y, x[2] - from.z});
    farthest2.note(moved2);
    poison += 0. * moved2;
    const double step2 = norm_square(Vec3{way[0], way[1], way[2]}), pace = p.pace[k],
                 paces2 = step2 / (pace * pace);
    most_paces2 = paces2 > most_paces2 ? paces2 : most_paces2;
    sum_step2 += step2;
  });
  p.clear_forces_on_pressed();
  const double n_awake = static_cast<double>(std::max<std::size_t>(p.n_awake(), 1));
  return {farthest2.first + poison, most_paces2, sum_step2 / n_awake, farthest2.second};
}

EUNOE_MULTIVERSION Travel first_step(ParticleArrays &p, const double dt)
{
  return kick_and_drift<false>(p, dt);
}

EUNOE_MULTIVERSION Travel next_step(ParticleArrays &p, const double dt)
{
  return kick_and_drift<true>(p, dt);
}

/// Half a kick, a drift, and after the forces the other half (Swope et al. 1982). A particle's
/// first half kick needs the force where it starts, so forces are computed before the first step
/// and after every insertion.
class VelocityVerlet : public Integrator
{
public:
  Travel begin_step(ParticleArrays &particles, double dt) override
  {
    const Travel travel = half_pending ? next_step(particles, dt) : first_step(particles, dt);
    half_pending = false;
    return travel;
  }

  void end_step() override { half_pending = true; }

  void complete(ParticleArrays &particles, double dt) override
  {
    if (half_pending)
      half_kick(particles, 0.5 * dt);
    half_pending = false;
  }

private:
  bool half_pending = false;
};

const IntegratorRegistry::Registration registration(
    integrators(), "velocity_verlet", IntegratorSection::without_entries<VelocityVerlet>);

} // namespace
} // namespace eunoe
