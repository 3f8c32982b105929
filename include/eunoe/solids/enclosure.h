#ifndef eunoe_solids_enclosure_h
#define eunoe_solids_enclosure_h

#include <eunoe/core/periodic_box.h>

#include <array>
#include <memory>
#include <vector>

namespace eunoe {

class BoxTree;

/// The space inside a closed surface of triangles, which may be open at periodic ends.
class Enclosure
{
public:
  struct Triangle
  {
    std::array<Vec3, 3> corner;
    int tag; ///< what `exit` gives
  };

  /// @param triangles with those around each periodic end repeated beyond the other end
  /// @param periods at most two directions
  Enclosure(std::vector<Triangle> triangles, const PeriodicBox &periods);
  ~Enclosure();

  /// Whether a position is inside; in periodic directions every one may be.
  bool contains(const Vec3 &x) const;

  /// Tag of the triangle through which the way from one place to another passed last, -1 if it
  /// passed none.
  int exit(const Vec3 &from, const Vec3 &to) const;

private:
  const std::vector<Triangle> triangles;
  const PeriodicBox periods;
  unsigned int up; ///< an axis that is not periodic, along which `contains` looks
  std::unique_ptr<const BoxTree> tree;
};

} // namespace eunoe

#endif
