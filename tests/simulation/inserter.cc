// When particles are inserted, which ones are removed to make room for them, which ones are left
// out, and how the inserter continues from a checkpoint.

#include <eunoe/simulation/inserter.h>

#include "../tests.h"
#include <nlohmann/json.hpp>

using namespace test;

namespace {

/// Supplies one particle at each of three events.
class Drops : public Insertion
{
public:
  explicit Drops(std::vector<bool> *leaving, const Vec3 &place = {})
      : leaving(leaving), place(place)
  {
  }

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
    drop.position = place;
    return {drop};
  }
  void skip(std::size_t n_events, std::size_t n_particles) override
  {
    n_done = n_events == n_particles ? n_events : 100;
  }
  bool finished() const override { return n_done == 3; }

private:
  std::vector<bool> *leaving;
  const Vec3 place;
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
  continued.load(nlohmann::ordered_json::parse(inserter.save().dump()));
  check("one is left", continued.is_due(20));
  const Inserter::Event last = continued.next_event(domain, particles, {}, 0.);
  check("its id has never been used", last.delivery.particles[0].id == 8);
  check("then there is none", !continued.is_due(30));

  const auto outside = [&] { return std::make_unique<Drops>(&leaving, Vec3{0., 0., 1.}); };
  Inserter above(parameters, outside());
  const Inserter::Event lost = above.next_event(domain, particles, {}, 0.);
  check("a place outside the mesh is left out",
        lost.delivery.particles.empty() && lost.n_outside == 1);
  Inserter above_continued(parameters, outside());
  above_continued.load(nlohmann::ordered_json::parse(above.save().dump()));
  above_continued.next_event(domain, particles, {}, 0.);
  above_continued.next_event(domain, particles, {}, 0.);
  check("and yet counts as supplied", !above_continued.is_due(30));

  parameters.frequency = 0;
  const Inserter once(parameters, std::make_unique<Drops>(&leaving));
  check("a single event", once.is_due(0) && !once.is_due(1) && !once.is_due(10));
  const Inserter of_process(parameters, nullptr);
  check("a process inserts its own", !of_process.is_due(0));
}
