#include <eunoe/contact/contact_law.h>
#include <eunoe/core/simd.h>

namespace eunoe {
namespace {

/// Coulomb's force between near particles whose charges sit in their centres, less what it is at
/// the cut-off, so that it ends there without a jump. Walls and solids are not charged.
class Charge : public ContactLaw
{
public:
  Charge(const Materials &materials, const ContactLawOptions &options)
      : table(materials.table([](const Material &a, const Material &b) {
          return Row{4. * M_PI * a.surface_charge * b.surface_charge / vacuum_permittivity};
        })),
        cut_off(options.charge_cut_off * options.largest_radius)
  {
  }

  double range(int) const override { return cut_off; }

  void apply(PairBlock &block, unsigned int, double) const override
  {
    alignas(64) PairBlock::Lanes strength;
    look_up(block, table, &Row::strength, strength);
    kernel(block, strength, cut_off);
  }

private:
  static constexpr double vacuum_permittivity = 8.8541878128e-12; ///< CODATA 2018 (F/m)

  struct Row
  {
    /// Of the force over the squared product of effective radius and sum of the radii, times the
    /// squared distance (N/m2).
    double strength;
  };

  EUNOE_MULTIVERSION static void kernel(PairBlock &b, const double *strength, const double cut_off)
  {
#pragma omp simd
    for (unsigned int k = 0; k < PairBlock::size; ++k) {
      const double distance = b.distance[k];
      const double radii = distance + b.overlap[k];
      const double end = radii + cut_off;
      // The product of the two radii.
      const double product = b.radius[k] * radii;
      const double force =
          strength[k] * product * product * (1. / (distance * distance) - 1. / (end * end));
      b.cohesion[k] -= strength[k] != 0. && distance < end ? force : 0.;
    }
  }

  const std::vector<Row> table;
  const double cut_off;
};

bool any_is_charged(const Materials &materials)
{
  for (int m = 0; m < materials.size(); ++m)
    if (materials[m].surface_charge != 0.)
      return true;
  return false;
}

const ContactLawRegistry::Registration registration(
    contact_laws("further"), "charge",
    [](const Materials &materials, const ContactLawOptions &options) {
      return any_is_charged(materials) && options.charge_cut_off > 0.
                 ? std::make_unique<Charge>(materials, options)
                 : nullptr;
    });

} // namespace
} // namespace eunoe
