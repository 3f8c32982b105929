#include <eunoe/core/problems.h>
#include <eunoe/state/particle_ids.h>

namespace eunoe {

ParticleId ParticleIds::take(const std::uint64_t n)
{
  const std::uint64_t left = std::uint64_t(last) + 1 - first_free;
  if (n > left)
    throw UserError(
        std::to_string(n) + " particles are to be inserted, but of the " + std::to_string(last) +
        " ids that there are in a run, which are never used "
        "again, only " +
        std::to_string(left) +
        " are left. Nothing was inserted, and the checkpoints are as they were. Insert "
        "fewer particles or smaller beds, or begin a new run with the particles of this "
        "one's last picture ('insertion method = file').");
  const ParticleId first = first_free;
  first_free += static_cast<ParticleId>(n);
  return first;
}

} // namespace eunoe
