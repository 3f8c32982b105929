#ifndef eunoe_solids_box_tree_h
#define eunoe_solids_box_tree_h

// For source files only, as Boost's R-tree takes long to compile.

#include <eunoe/solids/shape.h>

#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/geometry/strategies/strategies.hpp>

#include <cstdint>
#include <utility>
#include <vector>

namespace eunoe {

/// Finds boxes by where they are (an R-tree of Boost).
class BoxTree
{
public:
  /// @param boxes by the number under which they are found
  explicit BoxTree(const std::vector<std::pair<Box, std::int32_t>> &boxes) : tree(entries(boxes)) {}

  /// Calls `action(number)` for every box that meets another one, touching it at least, until one
  /// call returns true.
  /// @return whether one did
  template <typename Action>
  bool any_meeting(const Box &box, const Action &action) const
  {
    return any(boost::geometry::index::intersects(to_boost(box)), action);
  }

  /// Calls `action(number)` for every box that meets another one.
  template <typename Action>
  void for_each_meeting(const Box &box, const Action &action) const
  {
    any_meeting(box, [&action](const std::int32_t number) {
      action(number);
      return false;
    });
  }

  /// Calls `action(number)` for every box that holds a point.
  template <typename Action>
  void for_each_around(const Vec3 &x, const Action &action) const
  {
    for_each_meeting({x, x}, action);
  }

  /// Calls `action(number)` for the @p n boxes that are nearest to a point.
  template <typename Action>
  void for_each_nearest(const Vec3 &x, const unsigned int n, const Action &action) const
  {
    any(boost::geometry::index::nearest(to_boost(x), n), [&action](const std::int32_t number) {
      action(number);
      return false;
    });
  }

private:
  using BoostPoint = boost::geometry::model::point<double, 3, boost::geometry::cs::cartesian>;
  using BoostBox = boost::geometry::model::box<BoostPoint>;
  using Entry = std::pair<BoostBox, std::int32_t>;

  static BoostPoint to_boost(const Vec3 &x) { return {x.x, x.y, x.z}; }
  static BoostBox to_boost(const Box &box) { return {to_boost(box.lower), to_boost(box.upper)}; }

  static std::vector<Entry> entries(const std::vector<std::pair<Box, std::int32_t>> &boxes)
  {
    std::vector<Entry> all;
    for (const auto &[box, number] : boxes)
      all.emplace_back(to_boost(box), number);
    return all;
  }

  template <typename Query, typename Action>
  bool any(const Query &query, const Action &action) const
  {
    for (auto it = tree.qbegin(query); it != tree.qend(); ++it)
      if (action(it->second))
        return true;
    return false;
  }

  boost::geometry::index::rtree<Entry, boost::geometry::index::quadratic<16>> tree;
};

} // namespace eunoe

#endif
