#include <eunoe/core/simd.h>
#include <eunoe/engine/integrator.h>

namespace eunoe {
namespace {

EUNOE_ALWAYS_INLINE void kick(Quad &velocity, const Quad &force, const double dt)
{
  const double s = dt / velocity.w;
  velocity.x += s * force.x;
  velocity.y += s * force.y;
  velocity.z += s * force.z;
}

EUNOE_MULTIVERSION void half_kick(ParticleArrays &p, const double half_dt)
{
  p.for_each_awake([&](const std::size_t k) {
    kick(p.velocity[k], p.force[k], half_dt);
    kick(p.spin[k], p.torque[k], half_dt);
  });
}

template <bool twice>
EUNOE_ALWAYS_INLINE double kick_and_drift(ParticleArrays &p, const double dt)
{
  const double half_dt = 0.5 * dt;
  // A maximum ignores NaN; this sum does not.
  double largest = 0., poison = 0.;
  p.for_each_awake([&](const std::size_t k) {
    Quad &v = p.velocity[k], &w = p.spin[k], &x = p.position[k];
    if (twice) {
      kick(v, p.force[k], half_dt);
      kick(w, p.torque[k], half_dt);
    }
    kick(v, p.force[k], half_dt);
    kick(w, p.torque[k], half_dt);
    x.x += dt * v.x;
    x.y += dt * v.y;
    x.z += dt * v.z;
    const Vec3 moved = x.vec() - p.reference[k];
    const double moved2 = norm_square(moved);
    largest = moved2 > largest ? moved2 : largest;
    poison += 0. * moved2;
    p.force[k] = p.torque[k] = Quad();
  });
  if (!p.awake.empty())
    p.clear_forces_on_sleepers();
  return largest + poison;
}

EUNOE_MULTIVERSION double first_step(ParticleArrays &p, const double dt)
{
  return kick_and_drift<false>(p, dt);
}

EUNOE_MULTIVERSION double next_step(ParticleArrays &p, const double dt)
{
  return kick_and_drift<true>(p, dt);
}

/// Half a kick, a drift, and after the forces the other half (Swope et al. 1982). A particle's
/// first half kick needs the force where it starts, so forces are computed before the first step
/// and after every insertion.
class VelocityVerlet : public Integrator
{
public:
  double begin_step(ParticleArrays &particles, double dt) override
  {
    const double moved2 = half_pending ? next_step(particles, dt) : first_step(particles, dt);
    half_pending = false;
    return moved2;
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
