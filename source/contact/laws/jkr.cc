#include <eunoe/contact/contact_model.h>
#include <eunoe/core/simd.h>

#include <cstdint>
#include <cstring>

namespace eunoe {
namespace {

/// Cube root of a positive number in the range of a float, by operations that round alike on every
/// machine and that become vector code.
EUNOE_ALWAYS_INLINE double cube_root(const double x)
{
  const auto rough = static_cast<float>(x);
  std::int32_t bits;
  std::memcpy(&bits, &rough, sizeof bits);
  // A third of the exponent, and nearly one of the mantissa: 4 % off.
  bits = bits / 3 + 709921077;
  float start;
  std::memcpy(&start, &bits, sizeof start);
  double y = start;
  for (unsigned int halley = 0; halley < 3; ++halley) {
    const double cube = y * y * y;
    y *= (cube + 2. * x) / (2. * cube + x);
  }
  return y;
}

/// The positive root z of z^2 (z^2 + 4z + 6) = g^2. Newton's method for z sqrt(z^2 + 4z + 6) = g,
/// which is nearly a straight line up to z = 1 and a parabola beyond: from a start that is at most
/// 22 % off, four steps give all digits.
EUNOE_ALWAYS_INLINE double neck_root(const double g)
{
  double z = g / (1. + std::sqrt(1. + g));
  for (unsigned int newton = 0; newton < 4; ++newton) {
    const double root = std::sqrt(z * z + 4. * z + 6.);
    z -= (z * root - g) * root / (2. * z * z + 6. * z + 6.);
  }
  return z;
}

/// Elastic adhesive contact of Johnson, Kendall and Roberts (1971), with the damping and the
/// friction of adhesive contacts as in doc/physics.md.
///
/// It begins where the bodies touch and holds across a separation until the neck between them
/// tears. A contact remembers whether it has begun.
class Jkr : public ContactLaw
{
public:
  Jkr(const Materials &materials, const double largest_radius)
      : table(materials.table([](const Material &a, const Material &b) {
          const double young = effective_young_modulus(a, b), work = effective_surface_energy(a, b);
          return Row{young,
                     std::sqrt(2. * young) *
                         damping_factor(harmonic_mean(a.restitution, b.restitution)),
                     M_PI * work, std::cbrt(M_PI * work / (8. * young))};
        })),
        largest_radius(largest_radius)
  {
  }

  unsigned int history_size() const override { return 1; }

  double range(int kind) const override
  {
    // Against a wall the effective radius is the particle's own, the largest possible.
    const double neck = table[kind].neck * std::cbrt(largest_radius * largest_radius);
    return largest_radius > 0. ? 3. * neck * neck / largest_radius : 0.;
  }

  void apply(PairBlock &block, unsigned int history, double) const override
  {
    with_rows(block, table, [&](const auto &row) { kernel(block, row, block.history[history]); });
  }

private:
  struct Row
  {
    double young;
    double damping;  ///< over the root of contact radius and mass (N^(1/2)/m)
    double adhesion; ///< pi times the work of adhesion (N/m)
    double neck;     ///< least contact radius over the effective one to 2/3 (m^(1/3))
  };

  template <typename RowOf>
  EUNOE_MULTIVERSION static void kernel(PairBlock &b, const RowOf row, double *begun)
  {
    // Far into a contact with hardly any adhesion, the neck is taken as this share of the radius
    // of Hertz's contact: what that changes is less than rounding.
    constexpr double least_neck = 1e-12;
#pragma omp simd
    for (unsigned int k = 0; k < PairBlock::size; ++k) {
      const double overlap = b.overlap[k], radius = b.radius[k];
      const double root = cube_root(radius);
      const double torn = row(k).neck * root * root;
      const double torn2 = torn * torn;
      const double depth2 = overlap * radius;
      // The smallest normal number stands for "above zero".
      const double least_depth2 = begun[k] > 0. ? -3. * torn2 : 0x1p-1022;
      const bool touching = depth2 >= least_depth2;

      const double hertz2 = depth2 > 0. ? depth2 : 0.;
      const double least2 = least_neck * least_neck * hertz2;
      const double unit2 = torn2 > least2 ? torn2 : least2;
      const double above = depth2 / (unit2 > 0. ? unit2 : 1.) + 3.;
      const double z = neck_root(std::sqrt(above > 0. ? above : 0.));
      const double a = std::sqrt(unit2) * (1. + z) * (1. + z);

      const double stiffness = 4. / 3. * row(k).young * a;
      const double elastic =
          stiffness * a * a / radius - std::sqrt(8. * row(k).adhesion * row(k).young * a * a * a);
      const double damping_root = std::sqrt(a * b.mass[k]);
      const double damper = row(k).damping * damping_root;
      // Friction and rolling resistance feel the load together with twice the pull-off force
      // (Thornton 1991), which is taken off again as cohesion.
      const double twice_pull_off = 3. * row(k).adhesion * radius;
      b.contact_radius[k] = touching ? a : 0.;
      b.damping_root[k] = touching ? damping_root : 0.;
      b.stiffness[k] = touching ? stiffness : 0.;
      b.contact_force[k] = touching ? elastic + twice_pull_off + damper * b.closing_speed[k] : 0.;
      b.cohesion[k] += touching ? twice_pull_off : 0.;
      begun[k] = touching ? 1. : 0.;
    }
  }

  const std::vector<Row> table;
  const double largest_radius;
};

NamedContactModel jkr_model()
{
  return {"JKR", {"jkr", {}, "mindlin_limit_overlap"}, true};
}

const ContactLawRegistry::Registration registration(contact_laws("normal"), "jkr",
                                                    ContactLawSection::without_entries<Jkr>);
const ContactModelRegistry::Registration model(contact_models(), "JKR", jkr_model);
const ContactModelRegistry::Registration model_as_in_lethe(contact_models(), "hertz_JKR",
                                                           jkr_model);

} // namespace
} // namespace eunoe
