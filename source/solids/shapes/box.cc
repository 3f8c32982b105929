#include <eunoe/solids/shapes.h>

namespace eunoe {

TriangleMesh shapes::box(const Vec3 &l, const Vec3 &u)
{
  const auto corner = [&](int x, int y, int z) {
    return Vec3{x ? u.x : l.x, y ? u.y : l.y, z ? u.z : l.z};
  };
  TriangleMesh mesh;
  for (int side = 0; side < 2; ++side) {
    mesh.add_quad(corner(side, 0, 0), corner(side, 1, 0), corner(side, 1, 1), corner(side, 0, 1));
    mesh.add_quad(corner(0, side, 0), corner(1, side, 0), corner(1, side, 1), corner(0, side, 1));
    mesh.add_quad(corner(0, 0, side), corner(1, 0, side), corner(1, 1, side), corner(0, 1, side));
  }
  return mesh;
}

namespace {
/// Arguments: lower corner : upper corner.
const ShapeRegistry::Registration registration(named_shapes(), "box", [](ShapeArguments &a) {
  const Vec3 lower = a.vector(), upper = a.vector();
  return shapes::box(lower, upper);
});
} // namespace

} // namespace eunoe
