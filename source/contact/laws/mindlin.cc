#include <eunoe/contact/contact_model.h>
#include <eunoe/contact/turn_with_plane.h>
#include <eunoe/core/simd.h>

namespace eunoe {
namespace {

/// Mindlin's tangential spring with a memory of the slip, a damper and the Coulomb limit.
///
/// The spring's displacement is carried over the contact and turned with its plane. Past the limit
/// the force is scaled to it; with `limit_overlap` the displacement is then recomputed from the
/// limited force, else it keeps growing.
///
/// Beside a linear normal law the spring has 0.4 of its stiffness and the same damping ratio (Garg,
/// Galvin-Carney, Li, Pannala 2012).
enum class Spring
{
  mindlin,
  linear
};
template <Spring spring, bool limit_overlap>
class Mindlin : public ContactLaw
{
public:
  /// @param damping on the factor of Tsuji's damping
  Mindlin(const Materials &materials, const double damping)
      : table(materials.table([damping](const Material &a, const Material &b) {
          const double shear = 8. * effective_shear_modulus(a, b);
          return Row{shear,
                     (spring == Spring::linear ? 1. : std::sqrt(shear)) * damping *
                         damping_factor(harmonic_mean(a.restitution, b.restitution)),
                     harmonic_mean(a.friction, b.friction)};
        }))
  {
  }

  unsigned int history_size() const override { return 3; }

  void mirror(double *history, unsigned int axis) const override { history[axis] *= -1.; }

  void apply(PairBlock &block, unsigned int history, double dt) const override
  {
    with_rows(block, table, [&](const auto &row) {
      kernel(block, row, block.history[history], block.history[history + 1],
             block.history[history + 2], dt);
    });
  }

private:
  struct Row
  {
    double shear;   ///< stiffness over the contact radius (N/m2)
    double damping; ///< over the root of contact radius and mass, linear: of stiffness and mass
    double friction;
  };

  template <typename RowOf>
  EUNOE_MULTIVERSION static void kernel(PairBlock &b, const RowOf row, double *hx, double *hy,
                                        double *hz, const double dt)
  {
#pragma omp simd
    for (unsigned int k = 0; k < PairBlock::size; ++k) {
      const bool touching = b.contact_radius[k] > 0.;
      const double stiffness =
          spring == Spring::linear ? 0.4 * b.stiffness[k] : row(k).shear * b.contact_radius[k];
      const double damper =
          row(k).damping *
          (spring == Spring::linear ? std::sqrt(stiffness * b.mass[k]) : b.damping_root[k]);

      const Vec3 turned = turn_with_plane(hx[k], hy[k], hz[k], b.nx[k], b.ny[k], b.nz[k]);
      const double dx = turned.x + b.slip_x[k] * dt;
      const double dy = turned.y + b.slip_y[k] * dt;
      const double dz = turned.z + b.slip_z[k] * dt;

      const double damp_x = damper * b.slip_x[k];
      const double damp_y = damper * b.slip_y[k];
      const double damp_z = damper * b.slip_z[k];
      const double trial_x = stiffness * dx + damp_x;
      const double trial_y = stiffness * dy + damp_y;
      const double trial_z = stiffness * dz + damp_z;
      const double trial = std::sqrt(trial_x * trial_x + trial_y * trial_y + trial_z * trial_z);
      const double limit = row(k).friction * std::abs(b.contact_force[k]);
      const bool slides = trial > limit;
      // One division for two: by the trial force, and by the stiffness.
      const double both = 1. / (trial * stiffness);
      const double scale = slides ? limit * stiffness * both : 1.;
      const double fx = trial_x * scale;
      const double fy = trial_y * scale;
      const double fz = trial_z * scale;
      b.shear_x[k] += touching ? fx : 0.;
      b.shear_y[k] += touching ? fy : 0.;
      b.shear_z[k] += touching ? fz : 0.;

      const bool recompute = limit_overlap && slides;
      const double compliance = trial * both;
      const double kept_x = recompute ? (fx - damp_x) * compliance : dx;
      const double kept_y = recompute ? (fy - damp_y) * compliance : dy;
      const double kept_z = recompute ? (fz - damp_z) * compliance : dz;
      hx[k] = touching ? kept_x : 0.;
      hy[k] = touching ? kept_y : 0.;
      hz[k] = touching ? kept_z : 0.;
    }
  }

  const std::vector<Row> table;
};

/// The laws differ by their names alone, not by entries.
/// @param damping on the factor of Tsuji's damping
template <Spring spring, bool limit_overlap>
auto maker(const double damping)
{
  struct Section : public ContactLawSection
  {
    explicit Section(const double damping) : damping(damping) {}

    std::unique_ptr<ContactLaw> make(const Materials &materials, double) const override
    {
      return std::make_unique<Mindlin<spring, limit_overlap>>(materials, damping);
    }

    const double damping;
  };
  return [damping] { return std::make_unique<Section>(damping); };
}

/// Hertz's normal force with one of the laws.
auto model(const std::string &tangential)
{
  return [tangential] { return NamedContactModel{"nonlinear", {"hertz", {}, tangential}}; };
}

const ContactLawRegistry::Registration overlap(contact_laws("tangential"), "mindlin_limit_overlap",
                                               maker<Spring::mindlin, true>(1.));
const ContactLawRegistry::Registration force(contact_laws("tangential"), "mindlin_limit_force",
                                             maker<Spring::mindlin, false>(1.));
const ContactLawRegistry::Registration undamped(contact_laws("tangential"), "mindlin_undamped",
                                                maker<Spring::mindlin, false>(0.));
const ContactLawRegistry::Registration linear(contact_laws("tangential"), "linear_limit_overlap",
                                              maker<Spring::linear, true>(std::sqrt(6. / 5.)));

const ContactModelRegistry::Registration hertz(contact_models(), "hertz",
                                               model("mindlin_undamped"));
const ContactModelRegistry::Registration limit_overlap(contact_models(),
                                                       "hertz_mindlin_limit_overlap",
                                                       model("mindlin_limit_overlap"));
const ContactModelRegistry::Registration limit_force(contact_models(), "hertz_mindlin_limit_force",
                                                     model("mindlin_limit_force"));

} // namespace
} // namespace eunoe
