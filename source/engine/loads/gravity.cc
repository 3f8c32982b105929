#include <eunoe/engine/load.h>
#include <eunoe/state/physical_properties.h>

namespace eunoe {

LoadRegistry &loads()
{
  static LoadRegistry registry("load");
  return registry;
}

namespace {

/// The weight of the particles.
class Gravity : public Load
{
public:
  explicit Gravity(const Vec3 &g) : g(g) {}

  void add(ParticleArrays &p, double) const override
  {
    p.for_each_awake([&](const std::size_t k) {
      const double mass = p.mass(k);
      p.force[k].x += mass * g.x;
      p.force[k].y += mass * g.y;
      p.force[k].z += mass * g.z;
    });
  }

private:
  const Vec3 g;
};

class GravitySection : public LoadSection
{
public:
  std::unique_ptr<Load> make(const PhysicalProperties &physics) const override
  {
    return norm(physics.gravity) > 0. ? std::make_unique<Gravity>(physics.gravity) : nullptr;
  }
};

const LoadRegistry::Registration registration(loads(), "gravity",
                                              [] { return std::make_unique<GravitySection>(); });

} // namespace
} // namespace eunoe
