#ifndef eunoe_contact_contact_law_h
#define eunoe_contact_contact_law_h

#include <eunoe/contact/pair_block.h>
#include <eunoe/core/registry.h>
#include <eunoe/state/material.h>

#include <memory>
#include <string>
#include <vector>

namespace eunoe {

/// What the laws may need beside the materials; each law reads its own.
struct ContactLawOptions
{
  /// Share of the pull-off force at which the long-range attraction is cut off (C_FPO).
  double dmt_cut_off = 0.1;
  /// Share of the viscous rolling torque left once the spring is fully mobilised (f).
  double epsd_f = 0.;
  /// Whether EPSD's effective inertia is taken about the contact point (7/5 m R^2, Ai et al. 2011)
  /// or about the centres (2/5 m R^2).
  bool epsd_inertia_about_contact = true;

  double surface_tension = 0.; ///< of liquid bridges (N/m); 0: there are none
  double contact_angle = 0.;   ///< of the liquid (degrees)
  double bridge_share = 1e-3;  ///< volume of a bridge over that of a particle
  double bridge_volume = 0.;   ///< the same for all bridges if positive (m3)
  /// Gap at which the forces of charges end, over the largest radius.
  double charge_cut_off = 0.5;

  /// Of the particles (m); laws that act across gaps reach the farther, the larger they are.
  double largest_radius = 0.;
};

/// One mechanism of a contact: reads the geometry of a block of pairs (and what earlier laws
/// wrote) and adds its force or torque. A law is one file in source/contact/laws that registers
/// itself; CONTRIBUTING.md shows one being added.
class ContactLaw
{
public:
  virtual ~ContactLaw() = default;

  /// Number of doubles that a contact remembers for this law, oriented from i to j.
  virtual unsigned int history_size() const { return 0; }

  /// Turns what a contact remembers into that of its mirror image.
  /// @param axis normal to the mirror: 0, 1 or 2
  virtual void mirror(double * /*history*/, unsigned int /*axis*/) const {}

  /// Largest gap across which the law acts between two materials (m); the contact search reaches
  /// that far.
  /// @param kind of the pair of materials, see Materials::kind
  virtual double range(int /*kind*/) const { return 0.; }

  /// Applies the law to a whole block. @p history is the first component that belongs to the law;
  /// @p dt is the time by which the history advances (s), 0 to evaluate the present state.
  virtual void apply(PairBlock &block, unsigned int history, double dt) const = 0;
};

/// Laws by family ("normal", "cohesion", "further", "tangential", "rolling") and name. Those of the
/// family "further" join every model; their makers return null where their coefficients are zero.
using ContactLawRegistry =
    Registry<std::unique_ptr<ContactLaw>, const Materials &, const ContactLawOptions &>;
ContactLawRegistry &contact_laws(const std::string &family);

/// Copies one coefficient of each contact's row into @p lanes.
template <typename Row>
inline void look_up(const PairBlock &block, const std::vector<Row> &table, double Row::*coefficient,
                    double *lanes)
{
  if (block.uniform_kind >= 0) {
    const double value = table[block.uniform_kind].*coefficient;
    for (unsigned int k = 0; k < PairBlock::size; ++k)
      lanes[k] = value;
  } else
    for (unsigned int k = 0; k < PairBlock::size; ++k)
      lanes[k] = table[block.kind[k]].*coefficient;
}

} // namespace eunoe

#endif
