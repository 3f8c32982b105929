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
          const double young = effective_young_modulus(a, b);
          return Row{4. / 3. * young, std::sqrt(2. * young) * damping_factor(harmonic_mean(
                                                                  a.restitution, b.restitution))};
        }))
  {
  }

  void apply(PairBlock &block, unsigned int, double) const override
  {
    with_rows(block, table, [&](const auto &row) { kernel(block, row); });
  }

private:
  struct Row
  {
    double stiffness; ///< over the contact radius (N/m2)
    double damping;   ///< over the root of contact radius and mass (N^(1/2)/m)
  };

  template <typename RowOf>
  EUNOE_MULTIVERSION static void kernel(PairBlock &b, const RowOf row)
  {
#pragma omp simd
    for (unsigned int k = 0; k < PairBlock::size; ++k) {
      const double overlap = b.overlap[k] > 0. ? b.overlap[k] : 0.;
      const double contact_radius = std::sqrt(b.radius[k] * overlap);
      const double stiffness = row(k).stiffness * contact_radius;
      const double root = std::sqrt(contact_radius * b.mass[k]);
      b.contact_radius[k] = contact_radius;
      b.damping_root[k] = root;
      b.stiffness[k] = stiffness;
      b.contact_force[k] = stiffness * overlap + row(k).damping * root * b.closing_speed[k];
    }
  }

  const std::vector<Row> table;
};

const ContactLawRegistry::Registration registration(contact_laws("normal"), "hertz",
                                                    ContactLawSection::without_entries<Hertz>);

} // namespace
} // namespace eunoe
