#ifndef eunoe_processes_heap_apparatus_h
#define eunoe_processes_heap_apparatus_h

#include <eunoe/processes/heap/parameters.h>
#include <eunoe/solids/solid.h>
#include <eunoe/state/new_particle.h>
#include <eunoe/state/physical_properties.h>

#include <array>

namespace eunoe::heap {

/// Rest, then a rise at constant velocity, then rest.
class Lift : public Motion
{
public:
  /// @param velocity upwards (m/s)
  explicit Lift(double velocity) : velocity(velocity) {}

  /// @param start of the rise (s)
  void begin(double start_of_rise, double height)
  {
    start = start_of_rise;
    way = height;
  }
  double end() const { return start + way / velocity; }
  RigidState at(double time) const override;

private:
  const double velocity;
  double start = std::numeric_limits<double>::infinity(), way = 0.;
};

/// Number of particles that the tube is to hold, at least 1; may be too large for any run.
double wanted_particles(const HeapParameters &parameters, const ParticleType &type);

/// The heap instrument: a disc whose face is the plane y = 0 around the origin, and a tube over
/// it. SI units.
class Apparatus
{
public:
  Apparatus(const HeapParameters &parameters, const PhysicalProperties &physics);

  double gravity; ///< (m/s2)
  unsigned int n_particles;
  double y_bottom, y_top, half_width; ///< of the domain
  double settled_height;              ///< that the powder in the tube is expected to have

  /// Height over the powder in the tube at which the rising tube stops.
  double clearance() const { return 4. * largest_diameter; }
  /// Height of a heap that has the paper's angle.
  double expected_heap() const;
  /// Top of the loose powder.
  double loose_height() const;

  /// Place of a loose particle, with a random shift that depends on the seed and its id.
  Vec3 loose_place(std::size_t k, ParticleId id) const;

  /// Whether a particle at a height is carried by the lifted tube, whose lower end is at
  /// @p tube_height: half of the clearance over the powder is left for what hangs from it.
  bool clings_to_tube(double height, double radius, double tube_height) const
  {
    return height + radius >= tube_height - 0.5 * clearance();
  }
  /// Whether a particle under the lifted tube lies on the disc or on others there; not so what
  /// clings to the disc's rim.
  bool is_on_disc(const Vec3 &x, double radius) const
  {
    return x.y > 0. && std::hypot(x.x, x.z) < 0.5 * p.disc_diameter + radius;
  }

  /// Expected durations of filling, lifting and coming to rest (s).
  std::array<double, 3> expected_durations() const;

  void add_solids(std::vector<Solid> &solids, int material) const;

  /// The lengths (m) and velocities (m/s) for programs that evaluate the run, as an object of JSON.
  std::string as_json(double density) const;

  std::shared_ptr<Lift> tube;

private:
  const HeapParameters p;
  double largest_diameter;
  double rim_height;
  double pitch;            ///< of the grid of loose particles
  std::vector<Vec3> layer; ///< places of a layer of loose particles, y = 0
};

} // namespace eunoe::heap

#endif
