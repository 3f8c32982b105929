#ifndef eunoe_solids_shapes_h
#define eunoe_solids_shapes_h

#include <eunoe/core/registry.h>
#include <eunoe/solids/triangulated_surface.h>

namespace eunoe {

/// Surfaces made in code, all lengths in m.
namespace shapes {

/// A parallelogram with one corner and the two edges that leave it.
TriangleMesh plane(const Vec3 &corner, const Vec3 &u, const Vec3 &v);

/// The six faces of a box.
TriangleMesh box(const Vec3 &lower, const Vec3 &upper);

/// The side of a cylinder without its ends.
/// @param base centre of one end
/// @param axis from that end to the other
TriangleMesh cylinder_shell(const Vec3 &base, const Vec3 &axis, double radius,
                            unsigned int n_facets);

/// A round plate: a flat face at the end of the axis, and a rim down to its beginning.
/// @param base centre of the lower end of the rim
/// @param axis from there to the centre of the face
TriangleMesh disc(const Vec3 &base, const Vec3 &axis, double radius, unsigned int n_facets);

/// A spreader along z: the lower half of a cylinder, with vertical sides above it.
/// @param tip start of its lowest line
/// @param length in z
/// @param height of the sides' upper edges over the tip, at least the radius
TriangleMesh half_round_bar(const Vec3 &tip, double length, double radius, double height,
                            unsigned int n_facets);

/// A spreader along z: a vertical plate with a flat lower face.
/// @param tip start of the front lower edge, at its largest x
TriangleMesh flat_blade(const Vec3 &tip, double length, double thickness, double height);

} // namespace shapes

/// Arguments of a shape in an input file: groups separated by ':' of numbers separated by ','.
class ShapeArguments
{
public:
  /// Throws std::invalid_argument with a sentence for anything that is not numbers.
  explicit ShapeArguments(const std::string &text);

  /// The next group, which must be a vector, a number, or a positive whole number.
  ///@{
  Vec3 vector();
  double number();
  unsigned int count();
  ///@}

  /// To be called when all have been taken.
  void finish() const;

private:
  const std::vector<double> &next(std::size_t n_values);

  std::vector<std::vector<double>> groups;
  std::size_t taken = 0;
};

using ShapeRegistry = Registry<TriangleMesh, ShapeArguments &>;
ShapeRegistry &named_shapes();

} // namespace eunoe

#endif
