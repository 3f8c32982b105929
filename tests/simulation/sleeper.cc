// When it is checked who sleeps, and what counts as a disturbance since the last check, also after
// a restart.

#include <eunoe/engine/sleeper.h>

#include "moving_solids.h"
#include <nlohmann/json.hpp>

using namespace test;

namespace {

/// A load that changes at a given time.
class Gust : public Load
{
public:
  explicit Gust(double moment) : moment(moment) {}

  void add(ParticleArrays &, double) const override {}
  bool changes(double begin, double end) const override { return begin < moment && moment <= end; }

private:
  const double moment;
};

/// The checks of a sleeper and the disturbances that they find, in steps of 1 s, with a floor that
/// begins to rise at 15 s, a gust at 25 s and a check frequency of 10.
std::string looks(unsigned long long restart)
{
  SparseContactParameters parameters;
  parameters.enabled = true;
  parameters.frequency = 10;
  MovingSolids solids;
  solids.take({rising("floor", 1., 15.), rising("other", 0.)});
  std::vector<std::unique_ptr<Load>> loads;
  loads.push_back(std::make_unique<Gust>(25.));
  Clock clock(1., 100);
  auto sleeper = std::make_unique<Sleeper>(parameters, 9.81, 1.);
  std::string all;
  const auto look = [&](bool wake_all) {
    const Stirring stirring = sleeper->look(clock, solids.list(), loads, wake_all);
    all += " " + std::to_string(stirring.step) + (stirring.everything ? "all" : "") +
           (stirring.solid_moves[0] ? "floor" : "") + (stirring.solid_moves[1] ? "other" : "");
  };
  solids.move_to(0.);
  look(true);
  while (clock.step() < 40) {
    clock.advance();
    solids.move_to(clock.time());
    if (sleeper->is_look_due(clock, solids.list()))
      look(false);
    if (clock.step() == restart) {
      const std::string saved = sleeper->save().dump();
      sleeper = std::make_unique<Sleeper>(parameters, 9.81, 1.);
      sleeper->load(nlohmann::ordered_json::parse(saved), 2);
    }
  }
  return all;
}

} // namespace

EUNOE_MPI_TEST()
{
  const std::string found = looks(0);
  check("looks and what they find",
        found == " 0allfloorother 10 15floor 20floor 30allfloor 40floor", found);
  check("restarted before the floor starts", looks(12) == found, looks(12));
  check("restarted after the gust", looks(33) == found, looks(33));
  const SparseContactParameters off;
  MovingSolids solids;
  check("never where nobody sleeps",
        !Sleeper(off, 1., 1.).is_look_due(Clock(1., 1), solids.list()));
}
