#include <eunoe/core/simd.h>

#include "rolling_friction.h"

namespace eunoe {
namespace {

/// Rolling resistance mu_r R_e |F_n| (R_e |w_p|) against the relative spin w_p: in proportion to
/// the speed by which the surfaces roll over each other, so that mu_r is in s/m (Zhou, Wright,
/// Yang, Xu, Yu 1999, model of the second kind).
struct ViscousRolling
{
  template <typename RowOf>
  EUNOE_MULTIVERSION static void kernel(PairBlock &b, const RowOf row)
  {
#pragma omp simd
    for (unsigned int k = 0; k < PairBlock::size; ++k) {
      const double factor =
          -row(k).friction * b.radius[k] * b.radius[k] * std::abs(b.contact_force[k]);
      b.torque_x[k] += factor * b.roll_x[k];
      b.torque_y[k] += factor * b.roll_y[k];
      b.torque_z[k] += factor * b.roll_z[k];
    }
  }
};

const ContactLawRegistry::Registration registration(
    contact_laws("rolling"), "viscous",
    ContactLawSection::without_entries<RollingFriction<ViscousRolling>>);

} // namespace
} // namespace eunoe
