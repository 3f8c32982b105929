#include <eunoe/contact/contact_law.h>
#include <eunoe/core/declare.h>
#include <eunoe/core/simd.h>

namespace eunoe {
namespace {

/// The liquid of all bridges.
struct Liquid
{
  double surface_tension = 0.; ///< (N/m); 0: there are no bridges
  double contact_angle = 0.;   ///< (degrees)
  double volume_share = 1e-3;  ///< volume of a bridge over that of a particle
  double bridge_volume = 0.;   ///< the same for all bridges if positive (m3)
};

/// Attraction by a pendular liquid bridge (Willett, Adams, Johnson, Seville 2000), which forms
/// where two bodies touch and holds until it is drawn out to its rupture distance (Lian, Thornton,
/// Adams 1993). A contact remembers whether it has a bridge. Liquid is not used up: every bridge
/// has the volume that the input gives.
class Capillary : public ContactLaw
{
public:
  Capillary(const Materials &materials, const Liquid &liquid, const double largest_radius)
      : table(make_table(materials, liquid)), largest_radius(largest_radius)
  {
  }

  unsigned int history_size() const override { return 1; }

  double range(int kind) const override
  {
    const Row &row = table[kind];
    return row.stretch * (row.length + row.length_share * largest_radius / row.radii);
  }

  void apply(PairBlock &block, unsigned int history, double) const override
  {
    with_rows(block, table, [&](const auto &row) { kernel(block, row, block.history[history]); });
  }

private:
  struct Row
  {
    double pull;         ///< force at contact over effective radius (N/m)
    double length;       ///< cube root of a bridge's volume, if that is given (m) ...
    double length_share; ///< ... else over the effective radius
    double stretch;      ///< rupture distance over the cube root of the volume
    double radii;        ///< radius of two equal particles, or of one at a wall, over the effective
  };

  static std::vector<Row> make_table(const Materials &materials, const Liquid &liquid)
  {
    const double angle = liquid.contact_angle * M_PI / 180.;
    const bool given = liquid.bridge_volume > 0.;
    std::vector<Row> table(materials.size() * materials.size());
    for (int a = 0; a < materials.size(); ++a)
      for (int b = 0; b < materials.size(); ++b) {
        Row &row = table[materials.kind(a, b)];
        row.pull = 4. * M_PI * liquid.surface_tension * std::cos(angle);
        row.radii = materials.is_wall(a) || materials.is_wall(b) ? 1. : 2.;
        row.length = given ? std::cbrt(liquid.bridge_volume) : 0.;
        row.length_share = given ? 0. : std::cbrt(4. / 3. * M_PI * liquid.volume_share) * row.radii;
        row.stretch = 1. + 0.5 * angle;
      }
    return table;
  }

  template <typename RowOf>
  EUNOE_MULTIVERSION static void kernel(PairBlock &b, const RowOf row, double *bridged)
  {
#pragma omp simd
    for (unsigned int k = 0; k < PairBlock::size; ++k) {
      const double separation = b.overlap[k] < 0. ? -b.overlap[k] : 0.;
      const double root = row(k).length + row(k).length_share * b.radius[k];
      const double rupture = bridged[k] > 0. ? row(k).stretch * root : 0.;
      const bool has_bridge = separation <= rupture;
      // Derjaguin's radius is twice the effective one.
      const double s = separation * std::sqrt(2. * b.radius[k] / (root * root * root));
      const double force = row(k).pull * b.radius[k] / (1. + 1.05 * s + 2.5 * s * s);
      b.cohesion[k] += has_bridge ? force : 0.;
      bridged[k] = has_bridge ? 1. : 0.;
    }
  }

  const std::vector<Row> table;
  const double largest_radius;
};

/// `subsection model parameters / capillary bridges`.
class CapillarySection : public ContactLawSection
{
public:
  void declare(dealii::ParameterHandler &prm) override
  {
    declare::enter(prm, path[0]);
    declare::enter(prm, path[1]);
    declare::not_negative(prm, "surface tension", liquid.surface_tension,
                          "Surface tension of the liquid that forms a bridge where two bodies "
                          "touch and holds it until they are too far apart (N/m); 0: no bridges.");
    declare::not_negative(prm, "contact angle", liquid.contact_angle,
                          "Angle at which the liquid meets the bodies (degrees).");
    declare::not_negative(prm, "volume share", liquid.volume_share,
                          "Volume of a bridge over that of a particle.");
    declare::not_negative(prm, "bridge volume", liquid.bridge_volume,
                          "Volume of every bridge (m3); 0: 'volume share' rules.");
    declare::leave(prm);
    declare::leave(prm);
  }

  void check(const ParameterCheck &check) const override
  {
    check.require(liquid.contact_angle < 90., path, "contact angle",
                  "is " + format(liquid.contact_angle) + " degrees.",
                  "Give an angle below 90: a liquid that does not wet draws nothing together.");
    check.require(liquid.surface_tension == 0. || liquid.bridge_volume > 0. ||
                      liquid.volume_share > 0.,
                  path, "volume share", "is 0 while there is a surface tension.",
                  "Give a share, or a 'bridge volume'.");
    check.require(liquid.volume_share <= largest_share, path, "volume share",
                  "is " + format(liquid.volume_share) + ".",
                  "Give at most " + format(largest_share) +
                      ": more liquid forms no single bridges.");
  }

  std::unique_ptr<ContactLaw> make(const Materials &materials,
                                   const double largest_radius) const override
  {
    if (liquid.surface_tension == 0.)
      return nullptr;
    return std::make_unique<Capillary>(materials, liquid, largest_radius);
  }

private:
  /// Above it, bridges of neighbours meet.
  static constexpr double largest_share = 0.1;

  const ParameterCheck::Path path = {"model parameters", "capillary bridges"};
  Liquid liquid;
};

const ContactLawRegistry::Registration registration(contact_laws("further"), "capillary", [] {
  return std::make_unique<CapillarySection>();
});

} // namespace
} // namespace eunoe
