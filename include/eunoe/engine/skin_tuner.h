#ifndef eunoe_engine_skin_tuner_h
#define eunoe_engine_skin_tuner_h

#include <nlohmann/json_fwd.hpp>

#include <cstdint>

namespace eunoe {

/// What a search finds, in numbers that are the same on any number of ranks.
struct SearchLoad
{
  std::uint64_t particles = 0, awake = 0;
  std::uint64_t pairs = 0; ///< listed ones, each once
};

/// What the choice of a skin costs, in steps of a particle in a settled bed, as the work by which
/// ranks share out particles is (`ParticleSystem::work`).
///
/// The values are estimates from the shares of time in doc/performance.md: a search costs some six
/// steps where a particle has four listed pairs, and some fifteen where it has fourteen. They need
/// not be exact, as the sum is flat around its least.
struct SkinCosts
{
  /// Of a search for each particle, and for each pair that it lists; with a share of the rarer
  /// searches in which particles find their ranks anew.
  double search = 3., found_pair = 0.8;
  /// Of a listed pair for each step: for longer lists and more ghosts.
  double listed_pair = 0.01;
  /// Likewise, divided by the root of the number of steps between two searches: for the lists of
  /// near pairs. These are made anew after a number of steps that goes by that root (`NearPairs`).
  double look = 0.08;
  /// Of a change of the skin for each particle: a search in which all is made anew.
  double change = 10.;
};

/// Chooses the skin by what searches and lists have cost of late: `neighborhood threshold = auto`.
///
/// The order in which forces are summed follows from the searches, and so do the last bits. So all
/// decisions are made of counts that are the same on any number of ranks, never of measured times,
/// and what they are made of is part of a checkpoint.
class SkinTuner
{
public:
  static constexpr double largest_threshold = 2.;

  /// @param diameter of the largest particle (m)
  /// @param first skin (m)
  /// @param most that the domain allows for (m)
  SkinTuner(double diameter, double first, double most, const SkinCosts &costs = {})
      : costs(costs), diameter(diameter), most(most), now(first)
  {
  }

  /// Separation up to which a search lists pairs (m).
  double skin() const { return now; }
  /// How often the skin has changed since the start of the program.
  unsigned long long n_changes() const { return changes; }

  /// Whether it is time to search although nothing has moved far: particles at rest may have lists
  /// that are too long.
  bool is_look_due(unsigned long long step) const { return step >= last_search + longest_wait; }

  /// To be called at a search that is due and has yet to be made.
  /// @param load of the lists so far
  /// @return whether it is to be made with another skin than the last one
  bool tune(unsigned long long step, const SearchLoad &load);

  /// To be called after every search.
  void note_search(const unsigned long long step) { last_search = step; }

  nlohmann::ordered_json save() const;
  void load(const nlohmann::ordered_json &saved);

private:
  /// Steps without a search after which one is made.
  static constexpr unsigned long long longest_wait = 5000;

  /// The searches on which the next decision rests, in sums.
  struct Window
  {
    std::uint64_t searches = 0, steps = 0;
    SearchLoad load;
  };

  bool is_complete() const;
  /// What a step of the window would have cost for each particle with another skin (m), as far as
  /// that depends on it.
  double cost(double skin) const;
  /// That of least cost (m).
  double best() const;
  /// Whether a change to another skin (m) is worth it.
  bool pays(double skin) const;

  const SkinCosts costs;
  const double diameter, most;
  double now;
  unsigned long long last_search = 0, changes = 0;
  Window window;
};

} // namespace eunoe

#endif
