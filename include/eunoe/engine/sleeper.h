#ifndef eunoe_engine_sleeper_h
#define eunoe_engine_sleeper_h

#include <eunoe/engine/clock.h>
#include <eunoe/engine/load.h>
#include <eunoe/engine/sparse_contacts.h>

namespace eunoe {

/// Decides when the sleepers are determined anew (a look), and notes disturbances from outside the
/// particles since the last look.
class Sleeper
{
public:
  /// @param gravity magnitude (m/s2)
  Sleeper(const SparseContactParameters &parameters, double gravity, double time_step)
      : sparse(parameters, gravity, time_step)
  {
  }

  /// Adds what it keeps of every particle, if anybody ever sleeps. Called once, before there are
  /// particles.
  void add_fields(ParticleFields &fields) { sparse.add_fields(fields); }

  bool is_enabled() const { return sparse.is_enabled(); }
  const SparseContacts &get() const { return sparse; }

  /// Whether it is time for a look, without a search.
  bool is_look_due(const Clock &clock, const std::vector<Solid> &solids) const;

  /// The disturbances since the last look; this call counts as a look.
  /// @param wake_all whether everything is to wake
  Stirring look(const Clock &clock, const std::vector<Solid> &solids,
                const std::vector<std::unique_ptr<Load>> &loads, bool wake_all);

  nlohmann::ordered_json save() const;
  /// @param n_solids number of solids of the run
  void load(const nlohmann::ordered_json &saved, std::size_t n_solids);

private:
  /// Whether a solid has begun to move, has come or gone since the last look.
  bool solid_starts(double time, const std::vector<Solid> &solids) const;

  SparseContacts sparse;
  double last_time = 0.;               ///< of the last look (s)
  std::vector<RigidState> last_states; ///< of the solids then
};

} // namespace eunoe

#endif
