#include <eunoe/core/declare.h>
#include <eunoe/engine/load.h>

#include <algorithm>
#include <cmath>

namespace eunoe {
namespace {

/// Drag of a still gas: Stokes's, with the correction of Schiller and Naumann (1933) for inertia
/// where the gas has a density.
class Drag : public Load
{
public:
  Drag(const double viscosity, const double density) : viscosity(viscosity), density(density) {}

  void add(ParticleArrays &p, double) const override
  {
    p.for_each_awake([&](const std::size_t k) {
      const Vec3 v = p.velocity[k].vec();
      const double radius = p.radius(k);
      const double stokes = 6. * M_PI * viscosity * radius;
      p.force[k].add(-stokes * correction(2. * radius * norm(v)) * v);
    });
  }

private:
  /// @param way diameter times speed (m2/s)
  double correction(const double way) const
  {
    // Newton's constant drag coefficient meets the formula there, so that the drag is continuous.
    constexpr double newton = 0.44;
    const double reynolds = density * way / viscosity;
    const double factor = reynolds > 0. ? 1. + 0.15 * std::pow(reynolds, 0.687) : 1.;
    return std::max(factor, newton / 24. * reynolds);
  }

  const double viscosity, density;
};

/// `subsection model parameters / drag`.
class DragSection : public LoadSection
{
public:
  void declare(dealii::ParameterHandler &prm) override
  {
    declare::enter(prm, "model parameters");
    declare::enter(prm, "drag");
    declare::not_negative(
        prm, "dynamic viscosity", viscosity,
        "Dynamic viscosity of the still gas around the particles (Pa s), 1.8e-5 for "
        "air; 0: no drag.");
    declare::not_negative(
        prm, "density", density,
        "Density of that gas (kg/m3), 1.2 for air. 0: Stokes's drag; else that of "
        "Schiller and Naumann.");
    declare::leave(prm);
    declare::leave(prm);
  }

  std::unique_ptr<Load> make(const PhysicalProperties &) const override
  {
    return viscosity > 0. ? std::make_unique<Drag>(viscosity, density) : nullptr;
  }

private:
  double viscosity = 0., density = 0.;
};

const LoadRegistry::Registration registration(loads(), "drag",
                                              [] { return std::make_unique<DragSection>(); });

} // namespace
} // namespace eunoe
