#include <eunoe/checkpoint/head_values.h>
#include <eunoe/core/declare.h>
#include <eunoe/core/gather.h>
#include <eunoe/simulation/simulation.h>
#include <eunoe/solids/saved_states.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <unordered_set>

namespace eunoe {
namespace {

class WallCollisionsSection : public ObservableSection
{
public:
  void declare(dealii::ParameterHandler &prm) override
  {
    for (const std::string &name : path)
      declare::enter(prm, name);
    declare::entry(prm, "enable particle wall collision statistics", calculation,
                   "Whether beginning and end of every collision of a particle with a wall of "
                   "the mesh are recorded.");
    declare::entry(prm, "log collisions with all walls", all_walls,
                   "Whether all walls of the mesh count, or those of 'wall boundary ids'.");
    declare::list(prm, "wall boundary ids", ids, {0, std::numeric_limits<unsigned int>::max(), 0},
                  "Boundaries that count if not all do.");
    declare::entry(prm, "collision statistics file", file,
                   "Name of the file; its values are separated by commas.");
    for (std::size_t k = 0; k < path.size(); ++k)
      declare::leave(prm);
  }

  void check(const ParameterCheck &check) const override
  {
    check.require(!file.empty() && file.find('/') == std::string::npos, path,
                  "collision statistics file", "is '" + file + "'.", "Give a name without '/'.");
  }

  std::vector<Table> tables() const override
  {
    return calculation ? std::vector<Table>{{path, "collision statistics file", file, file}}
                       : std::vector<Table>();
  }

  /// Throws a UserError if a boundary is named that is no wall.
  void find_walls(const Domain &domain) const
  {
    std::set<unsigned int> boundaries;
    for (const Solid &wall : domain.walls())
      boundaries.insert(*wall.boundary);
    std::string walls;
    for (const unsigned int id : boundaries)
      walls += (walls.empty() ? "" : ", ") + std::to_string(id);
    for (const unsigned int id : ids)
      if (boundaries.count(id) == 0)
        throw UserError(describe(path, "wall boundary ids") + " names " + std::to_string(id) +
                        ", which is no wall of the mesh. " +
                        (walls.empty() ? "The mesh has none." : "Name some of " + walls + "."));
  }

  /// Whether collisions with a solid are recorded.
  bool counts(const Solid &solid) const
  {
    return solid.boundary &&
           (all_walls || std::find(ids.begin(), ids.end(), *solid.boundary) != ids.end());
  }

  const ParameterCheck::Path path = {"post-processing", "particle wall collision statistics"};
  bool calculation = false, all_walls = true;
  std::vector<unsigned int> ids = {0};
  std::string file = "collision_statistics.csv";
};

/// A particle near a wall: while it touches, how the collision began; else how it moves now.
struct Approach
{
  ParticleId particle = 0;
  int wall = -1; ///< number of the solid, -1 for a place that holds none
  bool touches = false;
  double start = 0.;   ///< of the collision (s)
  Vec3 velocity, spin; ///< at the step before it (m/s, rad/s)

  /// The members in their order, as a checkpoint holds them.
  using Numbers = std::array<double, 10>;
  Numbers numbers() const
  {
    return {double(particle), double(wall), touches ? 1. : 0., start,
            velocity.x,       velocity.y,   velocity.z,        spin.x,
            spin.y,           spin.z};
  }
  static Approach of(const Numbers &n)
  {
    return {static_cast<ParticleId>(n[0]),
            static_cast<int>(n[1]),
            n[2] != 0.,
            n[3],
            {n[4], n[5], n[6]},
            {n[7], n[8], n[9]}};
  }
  bool operator<(const Approach &other) const { return numbers() < other.numbers(); }
};

/// A collision that is over.
struct Collision
{
  Approach beginning;
  double end;          ///< (s)
  Vec3 velocity, spin; ///< at its end (m/s, rad/s)

  /// By time and particle.
  bool operator<(const Collision &other) const
  {
    return end != other.end ? end < other.end : beginning < other.beginning;
  }
};

/// The entries of all ranks in their order; collective.
template <typename Entry>
std::vector<Entry> sorted_of_all_ranks(const std::vector<Entry> &mine, MPI_Comm comm)
{
  std::vector<Entry> all = gather_all(mine, comm);
  std::sort(all.begin(), all.end());
  return all;
}

/// Velocities before and after every collision of a particle with a wall of the mesh.
class WallCollisions : public Observable
{
public:
  WallCollisions(const WallCollisionsSection &section, Simulation &simulation)
      : comm(simulation.communicator()),
        file(simulation.output_folder().table(
            section.file,
            {"collision", "particle", "wall", "start_time", "start_v_x", "start_v_y", "start_v_z",
             "start_omega_x", "start_omega_y", "start_omega_z", "end_time", "end_v_x", "end_v_y",
             "end_v_z", "end_omega_x", "end_omega_y", "end_omega_z"}))
  {
    if (!section.all_walls)
      section.find_walls(simulation.get_domain());
    names = names_of(simulation.get_solids());
    for (const Solid &solid : simulation.get_solids()) {
      boundary.push_back(solid.boundary);
      counts.push_back(section.counts(solid));
    }
  }

  void step(Simulation &simulation) override
  {
    const ParticleArrays &p = simulation.complete_step();
    const ParticleSystem &system = simulation.get_system();
    const SolidContacts &contacts = system.get_solid_contacts();
    if (searches != system.n_searches()) {
      write();
      follow(p, contacts);
    }
    searches = system.n_searches();

    for (std::size_t k = 0; k < approaches.size(); ++k) {
      const SolidContacts::Candidate &candidate = contacts.get_candidates()[k];
      if (!counts[candidate.solid])
        continue;
      const std::int32_t row = candidate.particle;
      const Vec3 x = p.position[row].vec();
      const Vec3 v = p.velocity[row].vec(), w = p.spin[row].vec();
      const bool touches =
          contacts.deepest_overlap(candidate, simulation.get_solids()[candidate.solid], x,
                                   p.radius(row)) > 0.;
      Approach &approach = approaches[k];
      if (approach.touches && !touches)
        ended.push_back({approach, simulation.time(), v, w});
      if (touches && !approach.touches)
        // Velocities are those of the step before, if there was one near the wall.
        approach = {p.id[row],
                    candidate.solid,
                    true,
                    simulation.time(),
                    approach.wall < 0 ? v : approach.velocity,
                    approach.wall < 0 ? w : approach.spin};
      else if (!touches)
        approach = {p.id[row], candidate.solid, false, 0., v, w};
    }
  }

  void draw(Simulation &) override { write(); }

  void finish(Simulation &) override { write(); }

  void save(nlohmann::ordered_json &json) override
  {
    write();
    json["collisions"] = n_collisions;
    json["solids"] = names;
    json["near"] = nlohmann::ordered_json::array();
    for (const Approach &approach : sorted_of_all_ranks(near_walls(), comm))
      json["near"].push_back(approach.numbers());
  }

  void resume(const nlohmann::ordered_json &json) override
  {
    n_collisions = count_in(json.at("collisions"));
    // In another phase a wall may have another number, or be gone.
    const std::vector<int> walls =
        numbers_now(json.at("solids").get<std::vector<std::string>>(), names);
    for (const auto &values : json.at("near")) {
      Approach::Numbers numbers;
      if (values.size() != numbers.size())
        throw std::invalid_argument("this is no particle near a wall");
      std::transform(values.begin(), values.end(), numbers.begin(), number_in);
      if (!(numbers[0] >= 0. && numbers[0] <= std::numeric_limits<ParticleId>::max() &&
            numbers[1] >= 0. && numbers[1] < static_cast<double>(walls.size())))
        throw std::invalid_argument("this is no particle near a wall");
      Approach approach = Approach::of(numbers);
      approach.wall = walls[static_cast<std::size_t>(approach.wall)];
      if (approach.wall >= 0)
        kept.push_back(approach);
    }
    has_kept = true;
  }

private:
  std::vector<Approach> near_walls() const
  {
    std::vector<Approach> mine;
    for (const Approach &approach : approaches)
      if (approach.wall >= 0)
        mine.push_back(approach);
    return mine;
  }

  /// After a search, puts what is remembered of each particle to its new place, on whatever rank;
  /// collective, as all ranks search together.
  void follow(const ParticleArrays &p, const SolidContacts &contacts)
  {
    std::vector<Approach> mine = has_kept ? kept : near_walls();
    if (!has_kept) {
      const std::unordered_set<ParticleId> owned(p.id.begin(),
                                                 p.id.begin() + static_cast<long>(p.n_owned));
      const auto gone =
          std::stable_partition(mine.begin(), mine.end(), [&owned](const Approach &approach) {
            return owned.count(approach.particle) > 0;
          });
      const auto moved = sorted_of_all_ranks(std::vector<Approach>(gone, mine.end()), comm);
      mine.erase(gone, mine.end());
      mine.insert(mine.end(), moved.begin(), moved.end());
    }
    has_kept = false;
    kept.clear();

    std::map<std::pair<ParticleId, int>, Approach> found;
    for (const Approach &approach : mine)
      found[{approach.particle, approach.wall}] = approach;
    approaches.assign(contacts.get_candidates().size(), Approach());
    for (std::size_t k = 0; k < approaches.size(); ++k) {
      const SolidContacts::Candidate &candidate = contacts.get_candidates()[k];
      const auto it = found.find({p.id[candidate.particle], candidate.solid});
      if (it != found.end())
        approaches[k] = it->second;
    }
  }

  /// Writes the collisions that have ended since the last time, of all ranks, by time and particle;
  /// collective. To do so after every step would make all ranks wait for each other once more.
  void write()
  {
    const std::vector<Collision> all = sorted_of_all_ranks(ended, comm);
    ended.clear();
    for (const auto &[beginning, end, velocity, spin] : all) {
      const auto &[particle, wall, touches, start, v, w] = beginning;
      file->write({static_cast<double>(n_collisions++), static_cast<double>(particle),
                   static_cast<double>(*boundary[wall]), start, v.x, v.y, v.z, w.x, w.y, w.z, end,
                   velocity.x, velocity.y, velocity.z, spin.x, spin.y, spin.z});
    }
  }

  MPI_Comm comm;
  const std::shared_ptr<CsvFile> file;
  std::vector<std::string> names;                    ///< of each solid
  std::vector<std::optional<unsigned int>> boundary; ///< likewise
  std::vector<bool> counts;                          ///< whether its collisions are recorded
  std::vector<Approach> approaches; ///< one per candidate of the contacts with solids
  /// Search at which the approaches were put in their places, at first none.
  unsigned long long searches = std::numeric_limits<unsigned long long>::max();
  std::vector<Collision> ended; ///< of this rank, not written yet
  std::uint64_t n_collisions = 0;
  std::vector<Approach> kept; ///< of all ranks, from a checkpoint
  bool has_kept = false;
};

const ObservableRegistry::Registration registration(observables(), "wall collisions", [] {
  return std::make_unique<SectionOf<WallCollisions, WallCollisionsSection>>();
});

} // namespace
} // namespace eunoe
