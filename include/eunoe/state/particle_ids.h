#ifndef eunoe_state_particle_ids_h
#define eunoe_state_particle_ids_h

#include <eunoe/state/particle_arrays.h>

#include <limits>

namespace eunoe {

/// Gives the particles of a run their ids, one after another from 1; none is given twice.
class ParticleIds
{
public:
  /// Last id that can be given. The largest number stands for "none" in searches for the smallest.
  static constexpr ParticleId last = std::numeric_limits<ParticleId>::max() - 1;

  /// Takes @p n ids, which must be the same number on every rank.
  /// @return the first of them
  /// Throws a UserError, on every rank alike, if there are not so many left; takes none then.
  ParticleId take(std::uint64_t n);

  /// First id that has never been taken.
  ParticleId next() const { return first_free; }
  /// Goes on where another run has stopped.
  void go_on_from(ParticleId next) { first_free = next; }

private:
  ParticleId first_free = 1;
};

} // namespace eunoe

#endif
