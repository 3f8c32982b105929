#include <eunoe/solids/shapes.h>

namespace eunoe {

TriangleMesh shapes::flat_blade(const Vec3 &tip, const double length, const double thickness,
                                const double height)
{
  const Vec3 depth = {0., 0., length}, up = {0., height, 0.}, back = {-thickness, 0., 0.};
  TriangleMesh mesh;
  mesh.add_quad(tip, tip + back, tip + back + depth, tip + depth);
  mesh.add_quad(tip, tip + up, tip + up + depth, tip + depth);
  mesh.add_quad(tip + back, tip + back + up, tip + back + up + depth, tip + back + depth);
  return mesh;
}

namespace {
/// Arguments: start of the front lower edge : length in z : thickness : height.
const ShapeRegistry::Registration registration(named_shapes(), "flat_blade", [](ShapeArguments &a) {
  const Vec3 tip = a.vector();
  const double length = a.number(), thickness = a.number();
  return shapes::flat_blade(tip, length, thickness, a.number());
});
} // namespace

} // namespace eunoe
