#include <eunoe/contact/contact_law.h>
#include <eunoe/core/declare.h>
#include <eunoe/core/simd.h>
#include <eunoe/state/material_property.h>

namespace eunoe {
namespace {

const MaterialProperty surface_charge(
    "surface charge density", MaterialProperty::Owner::particles, 0., {},
    "Charge of a particle over its surface (C/m2), of either sign; see 'model "
    "parameters / electrostatic charge'.");

/// Coulomb's force between near particles whose charges sit in their centres, less what it is at
/// the cut-off, so that it ends there without a jump. Walls and solids are not charged.
class Charge : public ContactLaw
{
public:
  /// @param cut_off separation at which the force ends (m)
  Charge(const Materials &materials, const double cut_off)
      : table(materials.table([](const Material &a, const Material &b) {
          return Row{4. * M_PI * surface_charge(a) * surface_charge(b) / vacuum_permittivity};
        })),
        cut_off(cut_off)
  {
  }

  double range(const int kind) const override
  {
    return table[static_cast<std::size_t>(kind)].strength != 0. ? cut_off : 0.;
  }

  void apply(PairBlock &block, unsigned int, double) const override
  {
    with_rows(block, table, [&](const auto &row) { kernel(block, row, cut_off); });
  }

private:
  static constexpr double vacuum_permittivity = 8.8541878128e-12; ///< CODATA 2018 (F/m)

  struct Row
  {
    /// The force times the squared distance, over the squared product of effective radius and sum
    /// of the radii (N/m2).
    double strength;
  };

  template <typename RowOf>
  EUNOE_MULTIVERSION static void kernel(PairBlock &b, const RowOf row, const double cut_off)
  {
#pragma omp simd
    for (unsigned int k = 0; k < PairBlock::size; ++k) {
      const double distance = b.distance[k];
      const double radii = distance + b.overlap[k];
      const double end = radii + cut_off;
      // The product of the two radii.
      const double product = b.radius[k] * radii;
      const double force =
          row(k).strength * product * product * (1. / (distance * distance) - 1. / (end * end));
      b.cohesion[k] -= row(k).strength != 0. && distance < end ? force : 0.;
    }
  }

  const std::vector<Row> table;
  const double cut_off;
};

bool any_is_charged(const Materials &materials)
{
  for (int m = 0; m < materials.size(); ++m)
    if (surface_charge(materials[m]) != 0.)
      return true;
  return false;
}

/// `subsection model parameters / electrostatic charge`.
class ChargeSection : public ContactLawSection
{
public:
  void declare(dealii::ParameterHandler &prm) override
  {
    declare::enter(prm, "model parameters");
    declare::enter(prm, "electrostatic charge");
    declare::not_negative(
        prm, "cut-off share", cut_off_share,
        "Separation at which the force between two charged particles has fallen to "
        "zero, over the largest radius. The larger, the longer the neighbour lists.");
    declare::leave(prm);
    declare::leave(prm);
  }

  std::unique_ptr<ContactLaw> make(const Materials &materials,
                                   const double largest_radius) const override
  {
    if (cut_off_share == 0. || !any_is_charged(materials))
      return nullptr;
    return std::make_unique<Charge>(materials, cut_off_share * largest_radius);
  }

private:
  double cut_off_share = 0.5;
};

const ContactLawRegistry::Registration registration(contact_laws("further"), "charge", [] {
  return std::make_unique<ChargeSection>();
});

} // namespace
} // namespace eunoe
