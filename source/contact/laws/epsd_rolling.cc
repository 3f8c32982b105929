#include <eunoe/contact/contact_law.h>
#include <eunoe/contact/turn_with_plane.h>
#include <eunoe/core/declare.h>
#include <eunoe/core/simd.h>

namespace eunoe {
namespace {

/// Elastic-plastic spring-dashpot rolling resistance (Ai, Chen, Rotter, Ooi 2011, model C):
/// a torsional spring on the relative spin, limited to mu_r R_e |F_n|, with a dashpot of which the
/// share f remains once the spring is fully mobilised. The spring's torque turns with the contact
/// plane.
class EpsdRolling : public ContactLaw
{
public:
  /// @param f share of the viscous torque left once the spring is fully mobilised
  /// @param inertia_factor on the effective inertia about the centres, 2/5 m R^2
  EpsdRolling(const Materials &materials, const double f, const double inertia_factor)
      : table(materials.table([&](const Material &a, const Material &b) {
          return Row{harmonic_mean(a.rolling_friction, b.rolling_friction),
                     3. * std::sqrt(inertia_factor) *
                         harmonic_mean(a.rolling_viscous_damping, b.rolling_viscous_damping)};
        })),
        f(f)
  {
  }

  unsigned int history_size() const override { return 3; }

  void mirror(double *history, unsigned int axis) const override
  {
    history[(axis + 1) % 3] *= -1.;
    history[(axis + 2) % 3] *= -1.;
  }

  void apply(PairBlock &block, unsigned int history, double dt) const override
  {
    with_rows(block, table, [&](const auto &row) {
      kernel(block, row, f, block.history[history], block.history[history + 1],
             block.history[history + 2], dt);
    });
  }

private:
  struct Row
  {
    double friction;
    double damping; ///< over the arm and the root of inertia and normal stiffness
  };

  template <typename RowOf>
  EUNOE_MULTIVERSION static void kernel(PairBlock &b, const RowOf row, const double f, double *hx,
                                        double *hy, double *hz, const double dt)
  {
#pragma omp simd
    for (unsigned int k = 0; k < PairBlock::size; ++k) {
      const bool touching = b.contact_radius[k] > 0.;
      const double arm = row(k).friction * b.radius[k];
      // 9/4 of the normal stiffness, at the arm.
      const double stiffness = 2.25 * b.stiffness[k] * arm * arm;
      const double damper = row(k).damping * arm * std::sqrt(b.inertia[k] * b.stiffness[k]);
      const double limit = arm * std::abs(b.contact_force[k]);

      const Vec3 turned = turn_with_plane(hx[k], hy[k], hz[k], b.nx[k], b.ny[k], b.nz[k]);
      const double mx = turned.x - stiffness * b.roll_x[k] * dt;
      const double my = turned.y - stiffness * b.roll_y[k] * dt;
      const double mz = turned.z - stiffness * b.roll_z[k] * dt;

      const double spring = std::sqrt(mx * mx + my * my + mz * mz);
      const bool mobilised = spring >= limit;
      const double scale = spring > limit ? limit / spring : 1.;
      const double dashpot = mobilised ? f * damper : damper;
      const double kept_x = touching ? mx * scale : 0.;
      const double kept_y = touching ? my * scale : 0.;
      const double kept_z = touching ? mz * scale : 0.;
      const double damper_left = touching ? dashpot : 0.;
      hx[k] = kept_x;
      hy[k] = kept_y;
      hz[k] = kept_z;
      b.torque_x[k] += kept_x - damper_left * b.roll_x[k];
      b.torque_y[k] += kept_y - damper_left * b.roll_y[k];
      b.torque_z[k] += kept_z - damper_left * b.roll_z[k];
    }
  }

  const std::vector<Row> table;
  const double f;
};

class EpsdSection : public ContactLawSection
{
public:
  void declare(dealii::ParameterHandler &prm) override
  {
    declare::enter(prm, "model parameters");
    declare::between(prm, "f coefficient", f, 0., 1.,
                     "EPSD: share of the viscous torque left once the spring is fully mobilised.");
    declare::choice(prm, "epsd inertia", inertia, "contact point|centre",
                    "EPSD: point about which the moments of inertia in the damping are taken. Ai "
                    "et al. (2011) use the contact point.");
    declare::leave(prm);
  }

  std::unique_ptr<ContactLaw> make(const Materials &materials, double) const override
  {
    // About the contact point 7/5 m R^2 instead of 2/5 m R^2.
    return std::make_unique<EpsdRolling>(materials, f, inertia == "contact point" ? 3.5 : 1.);
  }

private:
  double f = 0.;
  std::string inertia = "contact point";
};

const ContactLawRegistry::Registration registration(contact_laws("rolling"), "epsd",
                                                    [] { return std::make_unique<EpsdSection>(); });

} // namespace
} // namespace eunoe
