#include <eunoe/contact/contact_model.h>
#include <eunoe/core/simd.h>

#include <cmath>

namespace eunoe {
namespace {

/// A linear spring and damper. The stiffness is the one by which a contact at an impact of 1 m/s is
/// as deep as with Hertz's law (Tsuji's characteristic velocity),
///
///     k_n = 16/15 sqrt(R) Y (15 m V^2 / (16 sqrt(R) Y))^(1/5),  V = 1 m/s,
///
/// the damper -2 beta sqrt(m k_n), by which a head-on impact has the prescribed restitution.
class Linear : public ContactLaw
{
public:
  Linear(const Materials &materials, double)
      : table(materials.table([](const Material &a, const Material &b) {
          return Row{effective_young_modulus(a, b),
                     damping_factor(harmonic_mean(a.restitution, b.restitution)) /
                         std::sqrt(5. / 6.)};
        }))
  {
  }

  void apply(PairBlock &block, unsigned int, double) const override
  {
    alignas(64) PairBlock::Lanes stiffness;
    with_rows(block, table, [&](const auto &row) {
      for (unsigned int k = 0; k < PairBlock::size; ++k)
        stiffness[k] = linear_stiffness(row(k).young, block.radius[k], block.mass[k]);
      kernel(block, stiffness, row);
    });
  }

private:
  struct Row
  {
    double young, damping;
  };

  template <typename RowOf>
  EUNOE_MULTIVERSION static void kernel(PairBlock &b, const double *stiffness, const RowOf row)
  {
#pragma omp simd
    for (unsigned int k = 0; k < PairBlock::size; ++k) {
      const double overlap = b.overlap[k] > 0. ? b.overlap[k] : 0.;
      const double damper = row(k).damping * std::sqrt(stiffness[k] * b.mass[k]);
      const double force = stiffness[k] * overlap + damper * b.closing_speed[k];
      const double contact_radius = std::sqrt(b.radius[k] * overlap);
      b.contact_radius[k] = contact_radius;
      b.damping_root[k] = std::sqrt(contact_radius * b.mass[k]);
      b.stiffness[k] = overlap > 0. ? stiffness[k] : 0.;
      b.contact_force[k] = overlap > 0. ? force : 0.;
    }
  }

  const std::vector<Row> table;
};

const ContactLawRegistry::Registration registration(contact_laws("normal"), "linear",
                                                    ContactLawSection::without_entries<Linear>);
const ContactModelRegistry::Registration model(contact_models(), "linear", [] {
  return NamedContactModel{"linear", {"linear", {}, "linear_limit_overlap"}};
});

} // namespace
} // namespace eunoe
