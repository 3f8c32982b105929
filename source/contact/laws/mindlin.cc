#include <eunoe/contact/contact_law.h>
#include <eunoe/contact/turn_with_plane.h>
#include <eunoe/core/simd.h>

namespace eunoe {
namespace {

/// Mindlin's tangential spring with a memory of the slip, a damper and the Coulomb limit.
///
/// The spring's displacement is carried over the contact and turned with its plane. Past the limit
/// the force is scaled to it; with `limit_overlap` the displacement is then recomputed from the
/// limited force, else it keeps growing.
template <bool limit_overlap>
class Mindlin : public ContactLaw
{
public:
  explicit Mindlin(const Materials &materials)
      : table(materials.table([](const Material &a, const Material &b) {
          return Row{effective_shear_modulus(a, b),
                     damping_factor(harmonic_mean(a.restitution, b.restitution)),
                     harmonic_mean(a.friction, b.friction)};
        }))
  {
  }

  unsigned int history_size() const override { return 3; }

  void mirror(double *history, unsigned int axis) const override { history[axis] *= -1.; }

  void apply(PairBlock &block, unsigned int history, double dt) const override
  {
    alignas(64) PairBlock::Lanes shear, damping, friction;
    look_up(block, table, &Row::shear, shear);
    look_up(block, table, &Row::damping, damping);
    look_up(block, table, &Row::friction, friction);
    kernel(block, shear, damping, friction, block.history[history], block.history[history + 1],
           block.history[history + 2], dt);
  }

private:
  struct Row
  {
    double shear, damping, friction;
  };

  EUNOE_MULTIVERSION static void kernel(PairBlock &b, const double *shear, const double *damping,
                                        const double *friction, double *hx, double *hy, double *hz,
                                        const double dt)
  {
#pragma omp simd
    for (unsigned int k = 0; k < PairBlock::size; ++k) {
      const bool touching = b.contact_radius[k] > 0.;
      const double stiffness = 8. * shear[k] * b.contact_radius[k];
      const double damper = damping[k] * std::sqrt(stiffness * b.mass[k]);

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
      const double limit = friction[k] * std::abs(b.contact_force[k]);
      const bool slides = trial > limit;
      const double scale = slides ? limit / trial : 1.;
      const double fx = trial_x * scale;
      const double fy = trial_y * scale;
      const double fz = trial_z * scale;
      b.shear_x[k] += touching ? fx : 0.;
      b.shear_y[k] += touching ? fy : 0.;
      b.shear_z[k] += touching ? fz : 0.;

      const bool recompute = limit_overlap && slides;
      const double compliance = 1. / (touching ? stiffness : 1.);
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

template <bool limit_overlap>
std::unique_ptr<ContactLaw> make(const Materials &materials, const ContactLawOptions &)
{
  return std::make_unique<Mindlin<limit_overlap>>(materials);
}

const ContactLawRegistry::Registration overlap(contact_laws("tangential"), "mindlin_limit_overlap",
                                               make<true>);
const ContactLawRegistry::Registration force(contact_laws("tangential"), "mindlin_limit_force",
                                             make<false>);

} // namespace
} // namespace eunoe
