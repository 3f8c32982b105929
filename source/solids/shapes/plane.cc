#include <eunoe/solids/shapes.h>

namespace eunoe {

TriangleMesh shapes::plane(const Vec3 &corner, const Vec3 &u, const Vec3 &v)
{
  TriangleMesh mesh;
  mesh.add_quad(corner, corner + u, corner + u + v, corner + v);
  return mesh;
}

namespace {
/// Arguments: corner : edge : edge.
const ShapeRegistry::Registration registration(named_shapes(), "plane", [](ShapeArguments &a) {
  const Vec3 corner = a.vector(), u = a.vector(), v = a.vector();
  return shapes::plane(corner, u, v);
});
} // namespace

} // namespace eunoe
