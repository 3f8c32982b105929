#ifndef eunoe_source_contact_laws_rolling_friction_h
#define eunoe_source_contact_laws_rolling_friction_h

#include <eunoe/contact/contact_law.h>

namespace eunoe {

/// A rolling resistance without memory, that of `Model::kernel(block, row)`, where each
/// pair has the harmonic mean of its coefficients of rolling friction.
template <class Model>
class RollingFriction : public ContactLaw
{
public:
  RollingFriction(const Materials &materials, double)
      : table(materials.table([](const Material &a, const Material &b) {
          return Row{harmonic_mean(a.rolling_friction, b.rolling_friction)};
        }))
  {
  }

  void apply(PairBlock &block, unsigned int, double) const override
  {
    with_rows(block, table, [&](const auto &row) { Model::kernel(block, row); });
  }

private:
  struct Row
  {
    double friction;
  };

  const std::vector<Row> table;
};

} // namespace eunoe

#endif
