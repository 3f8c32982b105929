#include <eunoe/solids/shapes.h>

namespace eunoe {

TriangleMesh shapes::cylinder_shell(const Vec3 &base, const Vec3 &axis, const double radius,
                                    const unsigned int n_facets)
{
  const Vec3 along = axis / norm(axis);
  const Vec3 off_axis = std::abs(along.x) < 0.9 ? Vec3{1., 0., 0.} : Vec3{0., 1., 0.};
  const Vec3 u = cross(along, off_axis) / norm(cross(along, off_axis));
  const Vec3 v = cross(along, u);
  const auto rim = [&](unsigned int k) {
    const double angle = 2. * M_PI * (k % n_facets) / n_facets;
    return base + radius * (std::cos(angle) * u + std::sin(angle) * v);
  };
  TriangleMesh mesh;
  for (unsigned int k = 0; k < n_facets; ++k)
    mesh.add_quad(rim(k), rim(k + 1), rim(k + 1) + axis, rim(k) + axis);
  return mesh;
}

namespace {
/// Arguments: centre of one end : axis to the other end : radius : number of facets.
const ShapeRegistry::Registration registration(named_shapes(), "cylinder_shell",
                                               [](ShapeArguments &a) {
                                                 const Vec3 base = a.vector(), axis = a.vector();
                                                 const double radius = a.number();
                                                 return shapes::cylinder_shell(base, axis, radius,
                                                                               a.count());
                                               });
} // namespace

} // namespace eunoe
