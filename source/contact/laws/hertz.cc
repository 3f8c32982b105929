#include <eunoe/contact/contact_law.h>
#include <eunoe/core/simd.h>

namespace eunoe {
namespace {

/// Hertz's elastic force with Tsuji's damping, which gives back the prescribed restitution at any
/// impact speed (Tsuji, Tanaka, Ishida 1992).
class Hertz : public ContactLaw
{
public:
  Hertz(const Materials &materials, double)
      : table(materials.table([](const Material &a, const Material &b) {
          return Row{effective_young_modulus(a, b),
                     damping_factor(harmonic_mean(a.restitution, b.restitution))};
        }))
  {
  }

  void apply(PairBlock &block, unsigned int, double) const override
  {
    alignas(64) PairBlock::Lanes young, damping;
    look_up(block, table, &Row::young, young);
    look_up(block, table, &Row::damping, damping);
    kernel(block, young, damping);
  }

private:
  struct Row
  {
    double young, damping;
  };

  EUNOE_MULTIVERSION static void kernel(PairBlock &b, const double *young, const double *damping)
  {
#pragma omp simd
    for (unsigned int k = 0; k < PairBlock::size; ++k) {
      const double overlap = b.overlap[k] > 0. ? b.overlap[k] : 0.;
      const double contact_radius = std::sqrt(b.radius[k] * overlap);
      const double stiffness = 4. / 3. * young[k] * contact_radius;
      const double damper = damping[k] * std::sqrt(1.5 * stiffness * b.mass[k]);
      b.contact_radius[k] = contact_radius;
      b.stiffness[k] = stiffness;
      b.contact_force[k] = stiffness * overlap + damper * b.closing_speed[k];
    }
  }

  const std::vector<Row> table;
};

const ContactLawRegistry::Registration registration(contact_laws("normal"), "hertz",
                                                    ContactLawSection::without_entries<Hertz>);

} // namespace
} // namespace eunoe
