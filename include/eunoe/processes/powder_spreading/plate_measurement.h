#ifndef eunoe_processes_powder_spreading_plate_measurement_h
#define eunoe_processes_powder_spreading_plate_measurement_h

#include <eunoe/processes/powder_spreading/apparatus.h>
#include <eunoe/processes/powder_spreading/plate_profile.h>
#include <eunoe/processes/solid_fraction.h>

namespace eunoe::spreading {

/// What is measured of the powder on the measuring plate after the last layer. SI units.
class PlateMeasurement
{
public:
  /// @param is_periodic whether the slice is periodic in z
  /// @param plate_height of the measuring plate (m)
  PlateMeasurement(const SpreadingParameters &parameters, const Apparatus &apparatus,
                   const PhysicalProperties &physics, bool is_periodic, double plate_height);

  /// Adds a sphere (kg).
  void add(const Vec3 &centre, double radius, double mass);

  /// Unites the spheres of all ranks; collective.
  void reduce(MPI_Comm comm);

  void append_to(std::vector<Measurement> &measured) const;

private:
  const unsigned int n_bins;
  PlateProfile profile;
  SolidFraction density;
};

/// Layer relative density and cumulative relative density; not a number where they are not defined.
struct RelativeDensities
{
  double layer, cumulative;

  /// @param full volume of a layer (m3)
  /// @param volume, last, first volume of solid material on the plate now, before this layer and
  /// after layer 1 (m3)
  RelativeDensities(unsigned int number, double full, double volume, double last, double first);
};

} // namespace eunoe::spreading

#endif
