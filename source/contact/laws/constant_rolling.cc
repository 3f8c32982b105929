#include <eunoe/core/simd.h>

#include "rolling_friction.h"

namespace eunoe {
namespace {

/// Rolling resistance of constant magnitude mu_r R_e |F_n| against the whole relative spin, twist
/// included (Zhou, Wright, Yang, Xu, Yu 1999).
struct ConstantRolling
{
  template <typename RowOf>
  EUNOE_MULTIVERSION static void kernel(PairBlock &b, const RowOf row)
  {
#pragma omp simd
    for (unsigned int k = 0; k < PairBlock::size; ++k) {
      const double torque = row(k).friction * b.radius[k] * std::abs(b.contact_force[k]);
      const double wx = b.roll_x[k] + b.twist[k] * b.nx[k];
      const double wy = b.roll_y[k] + b.twist[k] * b.ny[k];
      const double wz = b.roll_z[k] + b.twist[k] * b.nz[k];
      const double speed2 = wx * wx + wy * wy + wz * wz;
      const double factor = speed2 > 0. ? -torque / std::sqrt(speed2 > 0. ? speed2 : 1.) : 0.;
      b.torque_x[k] += factor * wx;
      b.torque_y[k] += factor * wy;
      b.torque_z[k] += factor * wz;
    }
  }
};

const ContactLawRegistry::Registration registration(
    contact_laws("rolling"), "constant",
    ContactLawSection::without_entries<RollingFriction<ConstantRolling>>);

} // namespace
} // namespace eunoe
