#ifndef eunoe_simulation_inserter_h
#define eunoe_simulation_inserter_h

#include <eunoe/engine/particle_system.h>
#include <eunoe/simulation/insertion.h>

#include <nlohmann/json_fwd.hpp>

namespace eunoe {

/// Decides when particles are inserted, supplies them and gives all new ones their ids. A process
/// inserts its own, so that only the ids come from here.
class Inserter
{
public:
  /// @param method null for a process
  Inserter(const InsertionParameters &parameters, std::unique_ptr<Insertion> method)
      : parameters(parameters), method(std::move(method))
  {
  }

  /// Null for a process.
  const Insertion *get_method() const { return method.get(); }

  /// Whether particles are inserted after a step.
  bool is_due(unsigned long long step) const;
  /// Whether particles come after the first step.
  bool brings_more() const;
  /// Whether particles that have not come never will, after the first step.
  bool waits_for_ever() const;

  /// What is inserted and taken out at one time.
  struct Event
  {
    Delivery delivery;
    std::vector<std::size_t> removed; ///< rows of owned particles
    std::uint64_t n_outside = 0;      ///< the mesh, of all ranks; they are left out
  };
  /// The next event; collective.
  Event next_event(const Domain &domain, const ParticleArrays &particles,
                   const std::vector<Solid> &solids, double time);

  const ParticleIds &get_ids() const { return ids; }
  /// Takes ids for particles of all ranks, see ParticleIds::take.
  ParticleId take_ids(std::uint64_t n) { return ids.take(n); }

  nlohmann::ordered_json save() const;
  void load(const nlohmann::ordered_json &saved);

private:
  const InsertionParameters &parameters;
  const std::unique_ptr<Insertion> method;
  std::size_t n_events = 0;
  std::uint64_t n_supplied = 0; ///< particles of all ranks, with those outside the mesh
  ParticleIds ids;
};

} // namespace eunoe

#endif
