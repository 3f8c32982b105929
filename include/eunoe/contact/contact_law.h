#ifndef eunoe_contact_contact_law_h
#define eunoe_contact_contact_law_h

#include <eunoe/contact/pair_block.h>
#include <eunoe/core/plugin_section.h>
#include <eunoe/core/registry.h>
#include <eunoe/state/material.h>

#include <memory>
#include <string>
#include <vector>

namespace eunoe {

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

  /// Largest separation at which the law acts between two materials (m); the contact search reaches
  /// that far.
  /// @param kind of the pair of materials, see Materials::kind
  virtual double range(int /*kind*/) const { return 0.; }

  /// Applies the law to a whole block. @p history is the first component that belongs to the law;
  /// @p dt is the time by which the history advances (s), 0 to evaluate the present state.
  virtual void apply(PairBlock &block, unsigned int history, double dt) const = 0;
};

/// What the input says of a law, in entries that the law's own file declares. The law is made from
/// the materials and the largest radius of the particles (m): laws that act without contact may
/// reach farther for larger particles.
using ContactLawSection = PluginSection<ContactLaw, const Materials &, double>;

/// Laws by family ("normal", "cohesion", "further", "tangential", "rolling") and name. Those of the
/// family "further" join every model; their sections make none where their coefficients are zero.
using ContactLawRegistry = Registry<std::unique_ptr<ContactLawSection>>;
ContactLawRegistry &contact_laws(const std::string &family);

/// The row of a law's table that all contacts of a block have.
template <typename Row>
struct SameRow
{
  const Row row;
  const Row &operator()(unsigned int) const { return row; }
};

/// The rows of contacts between several kinds of materials.
template <typename Row>
struct RowByKind
{
  const Row *const table;
  const std::int32_t *const kind;
  const Row &operator()(const unsigned int k) const { return table[kind[k]]; }
};

/// Calls `kernel(row)`, where `row(k)` has the coefficients of the block's contact k.
template <typename Row, typename Kernel>
inline void with_rows(const PairBlock &block, const std::vector<Row> &table, const Kernel &kernel)
{
  if (block.uniform_kind >= 0)
    kernel(SameRow<Row>{table[block.uniform_kind]});
  else
    kernel(RowByKind<Row>{table.data(), block.kind});
}

} // namespace eunoe

#endif
