#include <eunoe/engine/integrator.h>

namespace eunoe {
namespace {

/// v += a dt with the old acceleration; before that x += v dt with the old velocity, or after it
/// with the new one (symplectic). First order both.
template <bool symplectic>
class Euler : public Integrator
{
public:
  Travel begin_step(ParticleArrays &p, double dt) override
  {
    // A maximum ignores NaN; this sum does not.
    TwoLargest farthest2;
    double poison = 0.;
    p.for_each_awake([&](const std::size_t k) {
      if (!symplectic)
        p.position[k].add(dt * p.velocity[k].vec());
      p.velocity[k].add(dt / p.mass(k) * p.force[k].vec());
      p.spin[k].add(dt / p.moment_of_inertia(k) * p.torque[k].vec());
      if (symplectic)
        p.position[k].add(dt * p.velocity[k].vec());
      const double moved2 = norm_square(p.position[k].vec() - p.reference[k]);
      farthest2.note(moved2);
      poison += 0. * moved2;
      p.start_forces(k);
    });
    p.clear_forces_on_pressed();
    return {farthest2.first + poison, Travel::unknown, Travel::unknown, farthest2.second};
  }

  void complete(ParticleArrays &, double) override {}
};

const IntegratorRegistry::Registration explicit_euler(
    integrators(), "explicit_euler", IntegratorSection::without_entries<Euler<false>>);
const IntegratorRegistry::Registration symplectic_euler(
    integrators(), "symplectic_euler", IntegratorSection::without_entries<Euler<true>>);

} // namespace
} // namespace eunoe
