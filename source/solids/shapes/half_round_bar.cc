#include <eunoe/core/parameter_section.h>
#include <eunoe/solids/shapes.h>

namespace eunoe {

TriangleMesh shapes::half_round_bar(const Vec3 &tip, const double length, const double radius,
                                    const double height, const unsigned int n_facets)
{
  const Vec3 depth = {0., 0., length};
  // With an odd number of facets the lowest one is flat, above the lowest line of the round bar.
  const double rise = n_facets % 2 == 0 ? 0. : radius * (1. - std::cos(0.5 * M_PI / n_facets));
  const auto rim = [&](unsigned int k) {
    const double angle = M_PI * (1. + static_cast<double>(k) / n_facets);
    return tip + Vec3{radius * std::cos(angle), radius * (1. + std::sin(angle)) - rise, 0.};
  };
  TriangleMesh mesh;
  for (unsigned int k = 0; k < n_facets; ++k)
    mesh.add_quad(rim(k), rim(k + 1), rim(k + 1) + depth, rim(k) + depth);
  if (height - radius + rise > 0.) {
    const Vec3 side = {0., height - radius + rise, 0.};
    for (const Vec3 &edge : {rim(0), rim(n_facets)})
      mesh.add_quad(edge, edge + side, edge + side + depth, edge + depth);
  }
  return mesh;
}

namespace {
/// Arguments: start of the lowest line : length in z : radius : height : number of facets.
const ShapeRegistry::Registration registration(
    named_shapes(), "half_round_bar", [](ShapeArguments &a) {
      const Vec3 tip = a.vector();
      const double length = a.number(), radius = a.number(), height = a.number();
      if (height < radius)
        throw std::invalid_argument("half_round_bar: the height of " + format(height) +
                                    " m is less than the radius of " + format(radius) + " m");
      return shapes::half_round_bar(tip, length, radius, height, a.count());
    });
} // namespace

} // namespace eunoe
