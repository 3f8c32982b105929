#ifndef eunoe_processes_powder_spreading_plate_profile_h
#define eunoe_processes_powder_spreading_plate_profile_h

#include <eunoe/core/exact_sum.h>
#include <eunoe/core/vec3.h>
#include <eunoe/simulation/measurement.h>

namespace eunoe::spreading {

/// What lies on the measuring plate, along the plate: the height of the powder's surface as a
/// profilometer sees it from above, and the mean diameter. SI units.
class PlateProfile
{
public:
  /// The part of the plate that is looked at.
  struct Area
  {
    double x_begin, x_end; ///< (m)
    double depth;          ///< in z, from 0 (m)
    bool is_periodic;      ///< in z
    double floor;          ///< height of the plate (m)
  };

  /// @param n_bins along x
  /// @param finest largest width of the columns in which heights are kept (m)
  PlateProfile(const Area &area, unsigned int n_bins, double finest);

  /// Adds a sphere (kg); those beside or below the plate change nothing.
  void add(const Vec3 &centre, double radius, double mass);

  /// Unites the spheres of all ranks; collective.
  void reduce(MPI_Comm comm);

  /// Mean height of the columns of a bin (m).
  double height(unsigned int bin) const;
  /// Standard deviation of the heights of all columns about their mean (m).
  double roughness() const;
  /// Mean diameter by mass of the spheres whose centres lie in a bin (m); not a number in an empty
  /// one.
  double mean_diameter(unsigned int bin) const;

private:
  struct Bin
  {
    ExactSum mass, moment;
  };

  const Area area;
  unsigned int columns_per_bin, n_z;
  double width_x, width_z;     ///< of a column (m)
  std::vector<double> heights; ///< `[column in x][column in z]`
  std::vector<Bin> bins;
};

} // namespace eunoe::spreading

#endif
