#ifndef eunoe_processes_solid_fraction_h
#define eunoe_processes_solid_fraction_h

#include <eunoe/core/exact_sum.h>
#include <eunoe/core/vec3.h>

#include <functional>

namespace eunoe {

/// The part of a horizontal plane over which powder is looked at.
struct Footprint
{
  double area; ///< (m2)
  /// Area of a horizontal circle around a point that lies in it (m2).
  std::function<double(const Vec3 &centre, double radius)> common;

  /// A disc around the axis x = z = 0.
  static Footprint disc(double radius);
  /// A strip between two places in x; in z it ends where the powder does.
  static Footprint strip(double x_begin, double x_end, double depth);
};

/// Solid fraction of powder by height, as a tomograph sees it: the share of solid material in
/// horizontal layers of equal thickness over a footprint. Where spheres overlap, both count. SI
/// units.
class SolidFraction
{
public:
  /// @param floor height at which the lowest layer begins (m)
  /// @param thickness of a layer (m)
  SolidFraction(Footprint footprint, double floor, double thickness, unsigned int n_layers);

  /// Adds a sphere.
  void add(const Vec3 &centre, double radius);

  /// Adds up the spheres of all ranks; collective.
  void reduce(MPI_Comm comm);

  unsigned int n_layers() const { return static_cast<unsigned int>(volumes.size()); }
  /// @param layer counted from the floor
  double operator()(unsigned int layer) const;

private:
  const Footprint footprint;
  const double floor, thickness;
  std::vector<ExactSum> volumes; ///< of solid material (m3)
};

} // namespace eunoe

#endif
