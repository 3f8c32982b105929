#ifndef eunoe_processes_heap_silhouettes_h
#define eunoe_processes_heap_silhouettes_h

#include <eunoe/core/vec3.h>

#include <mpi.h>
#include <string>
#include <vector>

namespace eunoe::heap {

/// The outlines of a heap of spheres as cameras around it see them: for each of several horizontal
/// directions, evenly spread over 180 degrees, the height of the highest sphere over every place of
/// the base line. The base is the plane y = 0, and the axis of the heap x = z = 0. SI units.
///
/// The base angle is that of the isosceles triangle with the disc's diameter as its base and the
/// area below the outline, atan(4 A / D^2): the angle of repose of the heap instrument.
class Silhouettes
{
public:
  /// @param overhang how far spheres may reach beyond the disc's edge (m)
  /// @param finest largest width of the columns in which heights are kept (m)
  Silhouettes(double disc_diameter, double overhang, unsigned int n_views, unsigned int n_bins,
              double finest);

  /// Adds a sphere to all views.
  void add(const Vec3 &centre, double radius);

  /// Unites the spheres of all ranks; collective.
  void reduce(MPI_Comm comm);

  unsigned int n_views() const { return static_cast<unsigned int>(heights.size()) / n_columns; }
  /// Direction of the base line of a view in the x-z plane, from x to z (radians).
  double direction(unsigned int view) const { return M_PI * view / n_views(); }
  /// Area below the outline (m2).
  double area(unsigned int view) const;
  /// Height of the highest point (m).
  double height(unsigned int view) const;
  /// (degrees)
  double base_angle(double area) const;

  /// A bin of the mean profile: its middle, and of the views' mean heights in it the mean and the
  /// standard deviation (m).
  struct Bin
  {
    double x, mean, spread;
  };
  std::vector<Bin> profile() const;

  /// Mean heights over all views and both sides in rings of equal width from the axis to the disc's
  /// edge (m).
  std::vector<double> rings(unsigned int n_rings) const;

  /// The mean of all views as a picture (a portable grey map): black where the heap is seen in
  /// every view, white where it is seen in none. A comment states its scale.
  std::string map() const;

private:
  double disc_diameter;
  unsigned int n_bins, columns_per_bin, n_columns;
  double width;                ///< of a column (m)
  double left;                 ///< where the first column begins (m)
  std::vector<double> heights; ///< `[view][column]`
};

} // namespace eunoe::heap

#endif
