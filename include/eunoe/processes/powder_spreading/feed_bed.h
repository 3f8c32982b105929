#ifndef eunoe_processes_powder_spreading_feed_bed_h
#define eunoe_processes_powder_spreading_feed_bed_h

#include <eunoe/processes/powder_spreading/apparatus.h>
#include <eunoe/simulation/simulation.h>

namespace eunoe::spreading {

/// A settled bed of powder, remembered with all its contacts, of which copies are put into the
/// reservoir: shifted and mirrored in z at random, stacked as high as wanted.
class FeedBed
{
public:
  /// Remembers the powder in the reservoir; collective.
  /// @param platform_height over which the bed stands (m)
  void take(Simulation &simulation, const Apparatus &apparatus, double platform_height);

  /// Number of particles of a copy.
  std::size_t size() const { return n_global; }

  /// Adds the bed to a checkpoint, and takes it from one; collective.
  void save(CheckpointWriter &writer) const;
  void load(Simulation &simulation, const Checkpoint &checkpoint);

  /// This rank's share of a stack of copies on a platform at @p platform_height that reaches up to
  /// the level of the transfer plate, with new ids; the same for any number of ranks. Collective.
  /// @param event number that makes shifts and mirrorings differ
  Delivery stack(Simulation &simulation, const Apparatus &apparatus, double platform_height,
                 unsigned int seed, unsigned int event) const;

private:
  double depth = 0.; ///< height of a copy (m)
  std::size_t n_global = 0;
  /// This rank's share: ids are places in the bed, heights are over the platform.
  std::vector<NewParticle> particles;
  ContactRows rows{0};
};

/// Particles that stand above the level of the bed in the reservoir: their rows.
std::vector<std::size_t> above_level(const ParticleArrays &particles, const Apparatus &apparatus);

/// All particles in the reservoir: their rows.
std::vector<std::size_t> in_reservoir(const ParticleArrays &particles, const Apparatus &apparatus);

/// Those that reach into it, too, from the edge of the transfer plate.
std::vector<std::size_t> reaching_into_reservoir(const ParticleArrays &particles,
                                                 const Apparatus &apparatus);

/// Those that a fresh bed could touch, too, if it is higher than the transfer plate: what lies
/// there at the edge.
std::vector<std::size_t> in_the_way(const ParticleArrays &particles, const Apparatus &apparatus);

} // namespace eunoe::spreading

#endif
