#ifndef eunoe_core_box_parts_h
#define eunoe_core_box_parts_h

#include <eunoe/core/periodic_box.h>

#include <vector>

namespace eunoe {

/// The parts of a box, one for each rank, each about as full as the others: the box is cut into
/// halves, across its longest side, until there are enough. Every rank knows all cuts.
class BoxParts
{
public:
  /// @param lower, upper corners of the box (m)
  /// @param box periods, which it spans
  /// @param sample some of the places that will be asked for, the same on every rank
  BoxParts(const Vec3 &lower, const Vec3 &upper, const PeriodicBox &box, std::vector<Vec3> sample,
           int n_parts);

  /// Places for which cuts are as even as they need to be.
  static std::size_t sample_size(int n_parts) { return 32 * static_cast<std::size_t>(n_parts); }

  /// The part with a place; one outside of the box belongs to a part at its border.
  int at(const Vec3 &x) const;

  /// All parts with places within a cube around a place, across periods, too.
  /// @param reach half the cube's side (m)
  /// @param parts ascending
  void near(const Vec3 &x, double reach, std::vector<int> &parts) const;

private:
  /// A box of several parts.
  struct Node
  {
    unsigned int axis;
    double cut;        ///< what is below belongs to the first child (m)
    int first, second; ///< children: nodes; -1 - p for the part p
  };

  using Iterator = std::vector<Vec3>::iterator;
  /// Makes the node of the parts [first, last).
  /// @return its number, as a child
  int make(int first, int last, const Vec3 &lower, const Vec3 &upper, Iterator begin, Iterator end);
  void collect(int child, const Vec3 &lower, const Vec3 &upper, std::vector<int> &parts) const;

  const Vec3 lower, upper;
  const PeriodicBox box;
  std::vector<Node> nodes;
  int root;
};

} // namespace eunoe

#endif
