#include <eunoe/solids/shapes.h>

namespace eunoe {

TriangleMesh shapes::disc(const Vec3 &base, const Vec3 &axis, const double radius,
                          const unsigned int n_facets)
{
  TriangleMesh mesh = cylinder_shell(base, axis, radius, n_facets);
  const auto first = static_cast<std::int32_t>(mesh.vertices.size());
  // The upper corners of a quadrilateral of the shell are its third and fourth.
  std::vector<Vec3> rim;
  for (unsigned int k = 0; k < n_facets; ++k)
    rim.push_back(mesh.vertices[4 * k + 3]);
  mesh.vertices.insert(mesh.vertices.end(), rim.begin(), rim.end());
  mesh.vertices.push_back(base + axis);
  const auto n = static_cast<std::int32_t>(n_facets);
  for (std::int32_t k = 0; k < n; ++k)
    mesh.triangles.push_back({first + n, first + k, first + (k + 1) % n});
  return mesh;
}

namespace {
/// Arguments: centre of the lower end of the rim : axis to the face : radius : number of facets.
const ShapeRegistry::Registration registration(named_shapes(), "disc", [](ShapeArguments &a) {
  const Vec3 base = a.vector(), axis = a.vector();
  const double radius = a.number();
  return shapes::disc(base, axis, radius, a.count());
});
} // namespace

} // namespace eunoe
