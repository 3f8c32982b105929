#include <eunoe/contact/contact_law.h>
#include <eunoe/core/simd.h>

namespace eunoe {
namespace {

/// Attraction by a pendular liquid bridge (Willett, Adams, Johnson, Seville 2000), which forms
/// where two bodies touch and holds until it is drawn out to its rupture distance (Lian, Thornton,
/// Adams 1993). A contact remembers whether it has a bridge. Liquid is not used up: every bridge
/// has the volume that the input gives.
class Capillary : public ContactLaw
{
public:
  Capillary(const Materials &materials, const ContactLawOptions &options)
      : table(make_table(materials, options)), largest_radius(options.largest_radius)
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
    alignas(64) PairBlock::Lanes pull, length, length_share, stretch;
    look_up(block, table, &Row::pull, pull);
    look_up(block, table, &Row::length, length);
    look_up(block, table, &Row::length_share, length_share);
    look_up(block, table, &Row::stretch, stretch);
    kernel(block, pull, length, length_share, stretch, block.history[history]);
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

  static std::vector<Row> make_table(const Materials &materials, const ContactLawOptions &options)
  {
    const double angle = options.contact_angle * M_PI / 180.;
    const bool given = options.bridge_volume > 0.;
    std::vector<Row> table(materials.size() * materials.size());
    for (int a = 0; a < materials.size(); ++a)
      for (int b = 0; b < materials.size(); ++b) {
        Row &row = table[materials.kind(a, b)];
        row.pull = 4. * M_PI * options.surface_tension * std::cos(angle);
        row.radii = materials.is_wall(a) || materials.is_wall(b) ? 1. : 2.;
        row.length = given ? std::cbrt(options.bridge_volume) : 0.;
        row.length_share =
            given ? 0. : std::cbrt(4. / 3. * M_PI * options.bridge_share) * row.radii;
        row.stretch = 1. + 0.5 * angle;
      }
    return table;
  }

  EUNOE_MULTIVERSION static void kernel(PairBlock &b, const double *pull, const double *length,
                                        const double *length_share, const double *stretch,
                                        double *bridged)
  {
#pragma omp simd
    for (unsigned int k = 0; k < PairBlock::size; ++k) {
      const double gap = b.overlap[k] < 0. ? -b.overlap[k] : 0.;
      const double root = length[k] + length_share[k] * b.radius[k];
      const bool has_bridge = gap == 0. || (bridged[k] > 0. && gap <= stretch[k] * root);
      // Derjaguin's radius is twice the effective one.
      const double s = gap * std::sqrt(2. * b.radius[k] / (root * root * root));
      const double force = pull[k] * b.radius[k] / (1. + 1.05 * s + 2.5 * s * s);
      b.cohesion[k] += has_bridge ? force : 0.;
      bridged[k] = has_bridge ? 1. : 0.;
    }
  }

  const std::vector<Row> table;
  const double largest_radius;
};

const ContactLawRegistry::Registration registration(
    contact_laws("further"), "capillary",
    [](const Materials &materials, const ContactLawOptions &options) {
      return options.surface_tension > 0. ? std::make_unique<Capillary>(materials, options)
                                          : nullptr;
    });

} // namespace
} // namespace eunoe
