#ifndef eunoe_processes_powder_spreading_apparatus_h
#define eunoe_processes_powder_spreading_apparatus_h

#include <eunoe/processes/powder_spreading/parameters.h>
#include <eunoe/solids/disturbed_motion.h>
#include <eunoe/solids/scheduled_motion.h>
#include <eunoe/solids/solid.h>
#include <eunoe/solids/triangulated_surface.h>
#include <eunoe/state/physical_properties.h>

#include <algorithm>
#include <array>

namespace eunoe::spreading {

/// Solid fraction of a settled bed, for estimates.
constexpr double bed_fraction = 0.55;

/// The spreading apparatus: x along the passes with the platform's left end at 0, y upwards with
/// the transfer plate's surface at 0, z periodic or between side walls. SI units.
///
///     |  platform  | transfer plate | gap | measuring plate | gap | exit plate | collector
///     0            x_transfer       x_gap x_plate           ...                x_end
///
/// Where rims are, they stand between the measuring plate and its gaps.
class Apparatus
{
public:
  /// @param largest_diameter of the powder (m)
  Apparatus(const SpreadingParameters &parameters, double largest_diameter);

  /// @name Places (m)
  ///@{
  double x_transfer, x_gap, x_plate, x_plate_end, x_exit, x_end;
  double y_bottom, y_top;
  double depth;
  /// Place of the spreader's lowest line at the start of a pass, and how far the spreader reaches
  /// before and behind that line.
  double x_start, front, rear;
  double spreader_height;
  /// Depth of the settled bed, of the one for the first pass, and the platform's height under each.
  double bed_depth, first_bed_depth;
  /// Height of the bed's surface before a stroke, over the transfer plate.
  double bed_level;
  ///@}

  /// Depth of the bed that a reservoir needs for strokes of so much together (m).
  double depth_for(double strokes) const { return std::max(bed_depth, strokes + p.bed_margin); }

  double plate_area() const { return (x_plate_end - x_plate) * depth; }
  /// Length of the path of a pass.
  double path() const { return x_end + rear - x_start; }
  /// Length of the pile that a stroke gives the spreader to push.
  double pile_length() const;

  /// Number of particles that a settled bed in the reservoir is expected to take.
  /// @param bed_depth (m)
  double particles_in_bed(const ParticleType &type, double bed_depth) const
  {
    const double volume = M_PI / 6. * type.sizes.make()->mean_cube();
    return bed_fraction * x_transfer * depth * bed_depth / volume;
  }
  /// Whether the reservoir is full when so many particles reach over the level of the bed: as
  /// many as a layer of the largest has. Fewer may stand or fly over a lower surface.
  bool is_full(const ParticleType &type, unsigned long long n_above) const
  {
    return static_cast<double>(n_above) >= particles_in_bed(type, type.sizes.make()->largest());
  }

  bool is_over_plate(const Vec3 &x, double plate_height) const
  {
    return x.x >= x_plate && x.x < x_plate_end && x.y > plate_height;
  }
  bool is_in_reservoir(const Vec3 &x) const { return x.x < x_transfer; }

  /// The lengths (m), velocities (m/s) and the powder's density (kg/m3) for programs that evaluate
  /// the run, as an object of JSON.
  std::string as_json(double density) const;

  /// Spreaders take turns, so that passes may overlap.
  static constexpr unsigned int n_spreaders = 2;

  /// Where the solids are among those of a run.
  struct SolidHandles
  {
    std::array<SolidHandle, n_spreaders> spreaders;
    SolidHandle platform, plate;
  };
  /// Adds the solids, with the motions that a schedule fills.
  SolidHandles add_solids(std::vector<Solid> &solids, int material) const;

  std::array<std::shared_ptr<PassMotion>, n_spreaders> spreaders;
  std::shared_ptr<StrokeMotion> platform, plate;
  /// The plate's motion where it yields under the spreader, else null.
  std::shared_ptr<YieldingMotion> yielding_plate;

private:
  /// Height of a tilted spreader's lowest line over its mean at a place in z (m).
  double tilt(double z) const;
  /// The level spreader from a place in z on.
  TriangleMesh spreader_piece(double z, double length) const;
  TriangleMesh spreader_surface() const;
  /// The walls and the top of a rim whose wall on the left is at x.
  TriangleMesh rim_piece(double x, double z, double length) const;

  const SpreadingParameters p;
  double margin; ///< by which surfaces reach out of the periodic slice
};

} // namespace eunoe::spreading

#endif
