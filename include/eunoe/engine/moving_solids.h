#ifndef eunoe_engine_moving_solids_h
#define eunoe_engine_moving_solids_h

#include <eunoe/solids/solid.h>

#include <nlohmann/json_fwd.hpp>

#include <limits>
#include <mpi.h>
#include <string>
#include <utility>
#include <vector>

namespace eunoe {

/// All solids of a run, walls among them: where they are, where they were when contacts were
/// searched, and the forces of particles on them.
class MovingSolids
{
public:
  /// Takes the solids of a run, once they are all known.
  /// @param n_given number of those that mesh and input give, the first; a process knows where its
  ///                own are
  void take(std::vector<Solid> &&all,
            std::size_t n_given = std::numeric_limits<std::size_t>::max());

  const std::vector<Solid> &list() const { return solids; }

  void move_to(double time);

  /// Notes that contacts are searched with the solids where they are.
  void note_search();
  /// Largest displacement of a point of a solid since (m).
  double moved_since_search() const;

  /// Where the forces of the coming evaluation are summed, from zero.
  std::vector<SolidLoad> &new_loads();
  /// Force and torque on every solid, of all ranks; collective.
  std::vector<SolidLoad> global_loads(MPI_Comm comm) const;

  /// Where they were at the last search.
  nlohmann::ordered_json save() const;
  /// By how far each given solid that is still there is now from where it was then (m).
  std::vector<std::pair<std::string, double>> jumps(const nlohmann::ordered_json &saved) const;
  /// Takes the solids back there.
  void load(const nlohmann::ordered_json &saved);

private:
  std::vector<Solid> solids;
  std::size_t n_given = 0;
  std::vector<RigidState> at_search;
  std::vector<SolidLoad> loads;
};

} // namespace eunoe

#endif
