#include <eunoe/state/material.h>

#include <cmath>

namespace eunoe {

double effective_young_modulus(const Material &a, const Material &b)
{
  return 1. / ((1. - a.poisson_ratio * a.poisson_ratio) / a.young_modulus +
               (1. - b.poisson_ratio * b.poisson_ratio) / b.young_modulus);
}

double effective_shear_modulus(const Material &a, const Material &b)
{
  return 1. / (2. * (2. - a.poisson_ratio) * (1. + a.poisson_ratio) / a.young_modulus +
               2. * (2. - b.poisson_ratio) * (1. + b.poisson_ratio) / b.young_modulus);
}

double effective_surface_energy(const Material &a, const Material &b)
{
  return 2. * std::sqrt(a.surface_energy * b.surface_energy);
}

double effective_hamaker_constant(const Material &a, const Material &b)
{
  return 0.5 * (a.hamaker_constant + b.hamaker_constant);
}

double harmonic_mean(const double a, const double b)
{
  return a + b > 0. ? 2. * a * b / (a + b) : 0.;
}

double damping_factor(const double restitution)
{
  double beta = -1.;
  if (restitution > 0.) {
    const double log_e = std::log(restitution);
    beta = log_e / std::sqrt(log_e * log_e + M_PI * M_PI);
  }
  return -2. * std::sqrt(5. / 6.) * beta;
}

double linear_stiffness(const double effective_young_modulus, const double effective_radius,
                        const double effective_mass)
{
  const double spring = 16. / 15. * std::sqrt(effective_radius) * effective_young_modulus;
  return spring * std::pow(effective_mass / spring, 0.2);
}

double hertz_tangent_stiffness(const double effective_young_modulus, const double effective_radius,
                               const double overlap)
{
  return 2. * effective_young_modulus * std::sqrt(effective_radius * overlap);
}

} // namespace eunoe
