#ifndef eunoe_simulation_insertion_h
#define eunoe_simulation_insertion_h

#include <eunoe/core/parameter_section.h>
#include <eunoe/core/registry.h>
#include <eunoe/state/new_particle.h>
#include <eunoe/state/particle_ids.h>
#include <eunoe/state/physical_properties.h>

#include <functional>
#include <mpi.h>

namespace eunoe {

class Domain;
class Log;
struct Solid;

/// What is present where an insertion places its particles.
struct Surroundings
{
  const Domain &domain;
  const ParticleArrays &particles;  ///< with ghosts
  const std::vector<bool> &leaving; ///< those that are taken out before, by their rows
  const std::vector<Solid> &solids; ///< and walls, where they are
  double time;                      ///< (s)
};

/// Entries of `subsection insertion info` that several methods read.
struct InsertionSettings
{
  unsigned int frequency = 0; ///< steps between events; 0: one event only
  Vec3 box_lower, box_upper = {1., 1., 1.};
  double maximum_offset = 0.; ///< Lethe has 1, by which neighbours overlap
  unsigned int seed = 1;
  Vec3 velocity, spin;
  std::string acceptance = "1", acceptance_constants; ///< a point is used where this is positive
  bool removes = false; ///< empties the removal box before every event
  Vec3 removal_lower, removal_upper = {1., 1., 1.};

  /// For methods that fill the box.
  void check_box(const ParameterCheck &check) const;
};

/// Supplies the particles of one event after another. Errors of its input are found
/// when it is made.
class Insertion
{
public:
  virtual ~Insertion() = default;

  /// Largest diameter that it can supply (m).
  virtual double largest_diameter() const = 0;

  /// Number of particles that @p n_events events supply together.
  virtual std::size_t supply(std::size_t n_events) const = 0;

  /// Whether the input gives the particles one by one, so that numbers and sizes in their type do
  /// not count.
  virtual bool gives_particles() const { return false; }

  /// Whether some of these particles never come, as their type has fewer.
  virtual bool is_cut_short() const { return false; }

  /// Whether every event comes to the same places.
  virtual bool repeats_places() const { return false; }

  /// Adds problems of the insertion with the mesh; collective.
  virtual void check(const Domain &, Problems &) const {}

  /// Looks around before the next event; collective.
  virtual void survey(const Surroundings &) {}

  /// This rank's share of the particles of the next event; the shares of all ranks together are
  /// the same for any number of ranks.
  /// @param ids from which the particles of all ranks take theirs; throws as they do
  virtual std::vector<NewParticle> next(ParticleIds &ids) = 0;

  /// Places of this rank's share of the particles, where they are known beforehand (m).
  virtual std::vector<Vec3> known_places() const { return {}; }

  /// This rank's share of the particles of the first events, as far as they are known beforehand;
  /// of very many on a grid only some.
  virtual std::vector<std::vector<NewParticle>> known_events() const { return {}; }

  /// Skips the particles of the first events, which have been supplied already.
  /// @param n_particles that they supplied
  virtual void skip(std::size_t n_events, std::size_t n_particles) = 0;

  /// Events that would have supplied as many particles as another method has.
  virtual std::size_t events_for(std::size_t /*n_particles*/) const { return 0; }

  /// Whether all particles have been supplied that come at its events.
  virtual bool finished() const = 0;

  /// Whether more particles would come if there were more events.
  virtual bool has_more() const { return !finished(); }
};

/// Takes particles outside a mesh out of a list.
/// @return their number
std::size_t leave_out_what_is_outside(std::vector<NewParticle> &particles, const Domain &domain);

/// What the input says of a method, in entries of `subsection insertion info` that the method's own
/// file declares.
class InsertionSection
{
public:
  virtual ~InsertionSection() = default;

  /// Called within the subsection.
  virtual void declare(dealii::ParameterHandler &) {}

  /// Asked of the chosen method only.
  virtual void check(const InsertionSettings &, const ParameterCheck &) const {}

  /// Announces work that takes more than a second.
  virtual void announce(const InsertionSettings &, const PhysicalProperties &, Log &) const {}

  /// Whether the insertion needs the cells of a mesh at rest.
  virtual bool needs_cells() const { return false; }

  virtual std::unique_ptr<Insertion> make(const InsertionSettings &settings,
                                          const PhysicalProperties &physics,
                                          MPI_Comm comm) const = 0;
};

using InsertionRegistry = Registry<std::unique_ptr<InsertionSection>>;
InsertionRegistry &insertion_methods();

/// `subsection insertion info`.
struct InsertionParameters : public ParameterSection, public InsertionSettings
{
  static constexpr const char *section = "insertion info";

  std::string method = "volume";
  std::map<std::string, std::shared_ptr<InsertionSection>> methods = insertion_methods().make_all();

  const InsertionSection &chosen() const { return *methods.at(method); }

  void declare(dealii::ParameterHandler &prm) override;
  void check(const ParameterCheck &check) const override;
};

/// Particles of all types that are still to come, one type after another.
class ParticleSupply
{
public:
  explicit ParticleSupply(const std::vector<ParticleType> &types);

  double largest_diameter() const { return largest; }
  std::size_t n_remaining() const;
  /// The k-th of those that remain, at no place yet.
  NewParticle particle(std::size_t k, ParticleId id) const;
  void take(std::size_t n);

private:
  std::vector<ParticleType> types;
  std::vector<std::unique_ptr<SizeDistribution>> sizes;
  std::vector<std::size_t> remaining; ///< of each type
  double largest = 0.;
};

/// Rank's part [first, second) of a range of @p n items.
std::pair<std::size_t, std::size_t> share_of(std::size_t n, MPI_Comm comm);

/// Particles in a regular grid of a box with a random offset each, as dense as asked for.
struct VolumeGrid
{
  Vec3 lower, upper;      ///< the box (m)
  double pitch = 0.;      ///< distance of the grid points (m)
  double offset = 0.;     ///< largest random shift in each direction (m)
  std::vector<int> order; ///< directions from the first filled to the last

  /// Leaves out the points, before their shift, that @p accepts refuses.
  void restrict_to(const std::function<bool(const Vec3 &)> &accepts);

  /// Number of points that fit.
  std::size_t capacity() const;
  /// The k-th point, shifted by draws that depend on (seed, id).
  Vec3 point(std::size_t k, unsigned int seed, ParticleId id) const;

private:
  /// Number of points in direction @p d, a whole number.
  double points_along(unsigned int d) const;
  /// Lower corner of the cell of the k-th point of all (m).
  Vec3 cell(std::size_t k) const;

  bool restricted = false;
  std::vector<std::uint32_t> accepted; ///< of all points, if not all are used
};

} // namespace eunoe

#endif
