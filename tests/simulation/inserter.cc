// When particles are inserted, which ones are removed to make room for them, and how the inserter
// continues from a checkpoint.

#include <eunoe/simulation/inserter.h>

#include "../tests.h"
#include <nlohmann/json.hpp>

using namespace test;

namespace {

/// Supplies one particle at each of three events.
class Drops : public Insertion
{
public:
  explicit Drops(std::vector<bool> *leaving) : leaving(leaving) {}

  double largest_diameter() const override { return 1e-3; }
  std::size_t supply(std::size_t n_events) const override
  {
    return std::min<std::size_t>(3, n_events);
  }
  void survey(const Surroundings &around) override { *leaving = around.leaving; }
  std::vector<NewParticle> next(ParticleIds &ids) override
  {
    ++n_done;
    NewParticle drop;
    drop.id = ids.take(1);
    return {drop};
  }
  void skip(std::size_t n_events, std::size_t n_particles) override
  {
    n_done = n_events == n_particles ? n_events : 100;
  }
  bool finished() const override { return n_done == 3; }

private:
  std::vector<bool> *leaving;
  std::size_t n_done = 0;
};

} // namespace

EUNOE_MPI_TEST()
{
  Case box(box_input(1e-6, 1e-6, ""));
  const Domain &domain = box->get_domain();
  ParticleArrays particles; // two owned ones and a ghost
  particles.resize(2, 1, 0);
  for (std::size_t row = 0; row < 3; ++row)
    particles.position[row] = {0., 0., 1e-3 * static_cast<double>(row), 1e-4};

  InsertionParameters parameters;
  parameters.frequency = 10;
  parameters.removes = true;
  parameters.removal_lower = {-1., -1., 0.5e-3};
  parameters.removal_upper = {1., 1., 1.};
  std::vector<bool> leaving;
  Inserter inserter(parameters, std::make_unique<Drops>(&leaving));
  check("due at the start and every ten steps",
        inserter.is_due(0) && !inserter.is_due(5) && inserter.is_due(10) && inserter.is_due(20));
  const Inserter::Event first = inserter.next_event(domain, particles, {}, 0.);
  check("a particle with the first id",
        first.delivery.particles.size() == 1 && first.delivery.particles[0].id == 1);
  check("who is in the way is removed", first.removed == std::vector<std::size_t>({1}));
  check("the method knows, of ghosts too", leaving == std::vector<bool>({false, true, true}));
  check("other ids come behind", inserter.take_ids(5) == 2 && inserter.get_ids().next() == 7);
  inserter.next_event(domain, particles, {}, 0.);

  Inserter continued(parameters, std::make_unique<Drops>(&leaving));
  continued.load(nlohmann::ordered_json::parse(inserter.save().dump()), 2);
  check("one is left", continued.is_due(20));
  const Inserter::Event last = continued.next_event(domain, particles, {}, 0.);
  check("its id has never been used", last.delivery.particles[0].id == 8);
  check("then there is none", !continued.is_due(30));

  parameters.frequency = 0;
  const Inserter once(parameters, std::make_unique<Drops>(&leaving));
  check("a single event", once.is_due(0) && !once.is_due(1) && !once.is_due(10));
  const Inserter of_process(parameters, nullptr);
  check("a process inserts its own", !of_process.is_due(0));
}
