#include <eunoe/contact/contact_model.h>
#include <eunoe/core/declare.h>
#include <eunoe/core/simd.h>

namespace eunoe {
namespace {

/// Derjaguin-Muller-Toporov cohesion with the long-range van der Waals part of Meier et al. 2019:
/// the pull-off force up to a small separation, then the attraction of two spheres, cut off where
/// it has fallen to a given share of the pull-off force.
class Dmt : public ContactLaw
{
public:
  /// @param cut_off_share of the pull-off force at which the attraction is cut off (C_FPO)
  Dmt(const Materials &materials, const double cut_off_share)
      : table(materials.table([&](const Material &a, const Material &b) {
          const double pull_off = 2. * M_PI * effective_surface_energy(a, b);
          const double van_der_waals = effective_hamaker_constant(a, b) / 6.;
          const double plateau = pull_off > 0. ? std::sqrt(van_der_waals / pull_off) : 0.;
          return Row{pull_off, van_der_waals, plateau, plateau / std::sqrt(cut_off_share)};
        }))
  {
  }

  double range(int kind) const override { return table[kind].cut_off; }

  void apply(PairBlock &block, unsigned int, double) const override
  {
    with_rows(block, table, [&](const auto &row) { kernel(block, row); });
  }

private:
  struct Row
  {
    double pull_off;      ///< pull-off force over effective radius (N/m)
    double van_der_waals; ///< A/6 (J)
    double plateau;       ///< separation up to which the pull-off force acts, |d_o| (m)
    double cut_off;       ///< separation beyond which nothing acts, |d*| (m)
  };

  template <typename RowOf>
  EUNOE_MULTIVERSION static void kernel(PairBlock &b, const RowOf row)
  {
#pragma omp simd
    for (unsigned int k = 0; k < PairBlock::size; ++k) {
      const double separation = -b.overlap[k];
      const bool far = separation > row(k).plateau;
      const double tail = row(k).van_der_waals / (far ? separation * separation : 1.);
      const double force = (far ? tail : row(k).pull_off) * b.radius[k];
      b.cohesion[k] += separation < row(k).cut_off || !far ? force : 0.;
    }
  }

  const std::vector<Row> table;
};

class DmtSection : public ContactLawSection
{
public:
  void declare(dealii::ParameterHandler &prm) override
  {
    declare::enter(prm, "model parameters");
    declare::between(prm, "dmt cut-off threshold", cut_off_share, 1e-6, 1.,
                     "Share of the pull-off force below which the long-range attraction is "
                     "dropped.");
    declare::leave(prm);
  }

  std::unique_ptr<ContactLaw> make(const Materials &materials, double) const override
  {
    return std::make_unique<Dmt>(materials, cut_off_share);
  }

private:
  double cut_off_share = 0.1;
};

const ContactLawRegistry::Registration registration(contact_laws("cohesion"), "dmt",
                                                    [] { return std::make_unique<DmtSection>(); });
const ContactModelRegistry::Registration model(contact_models(), "DMT", [] {
  return NamedContactModel{"DMT", {"hertz", {"dmt"}, "mindlin_limit_overlap"}, true};
});

} // namespace
} // namespace eunoe
