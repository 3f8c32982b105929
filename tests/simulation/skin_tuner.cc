// The skin in invented flows: it comes near the one of least cost, also where searches come less or
// more seldom than it expects, does not wander because they are irregular, and follows a flow that
// changes; a restart changes nothing.

#include <eunoe/engine/skin_tuner.h>

#include "../tests.h"
#include <nlohmann/json.hpp>

#include <limits>
#include <memory>
#include <stdexcept>

using namespace test;

namespace {

/// Lengths are in diameters.
constexpr double first = 0.3, most = 1.;

struct Flow
{
  std::string name;
  double steps; ///< between two searches with the first skin
  double pairs; ///< that each particle lists with it
  double power; ///< of the skin, by which the steps go
  double awake; ///< share of the particles

  double steps_with(const double skin) const
  {
    constexpr double longest = 5000.;
    return std::min(longest, steps * std::pow(skin / first, power));
  }
  double pairs_with(const double skin) const
  {
    return pairs * std::pow((1. + skin) / (1. + first), 3.);
  }
  double cost(const double skin) const
  {
    const SkinCosts costs;
    const double interval = steps_with(skin), listed = pairs_with(skin);
    return (costs.search + costs.found_pair * listed) / interval +
           awake * listed * (costs.listed_pair + costs.look / std::sqrt(interval));
  }
  double least_cost() const
  {
    double least = std::numeric_limits<double>::max();
    for (double skin = 0.05; skin < most + 0.001; skin += 0.01)
      least = std::min(least, cost(skin));
    return least;
  }
};

const Flow gas = {"gas", 8., 0.8, 1., 1.}, plough = {"plough", 340., 6.6, 1., 1.},
           soft = {"soft grains", 19., 5.3, 1., 1.}, rest = {"at rest", 1e6, 6.6, 1., 1.};

class Run
{
public:
  /// @param noise largest share by which intervals and pairs differ from their means
  /// @param restarts whether each search is made by a new tuner
  explicit Run(const double noise, const bool restarts = false)
      : noise(noise), restarts(restarts), tuner(new_one())
  {
  }

  /// Lets contacts be searched @p n times.
  void go(const Flow &flow, const unsigned int n)
  {
    constexpr double particles = 1e6;
    for (unsigned int k = 0; k < n; ++k) {
      const double skin = tuner->skin();
      step += static_cast<unsigned long long>(
          std::max(1., std::round(flow.steps_with(skin) * disturbance())));
      tuner->tune(step,
                  {static_cast<std::uint64_t>(particles),
                   static_cast<std::uint64_t>(particles * flow.awake),
                   static_cast<std::uint64_t>(particles * flow.pairs_with(skin) * disturbance())});
      tuner->note_search(step);
      history.push_back(tuner->skin());
      if (restarts) {
        const std::string saved = tuner->save().dump();
        tuner = new_one();
        tuner->load(nlohmann::ordered_json::parse(saved));
      }
    }
  }

  double skin() const { return tuner->skin(); }
  unsigned long long n_changes() const { return tuner->n_changes(); }

  std::vector<double> history; ///< skins

private:
  static std::unique_ptr<SkinTuner> new_one()
  {
    return std::make_unique<SkinTuner>(1., first, most);
  }

  double disturbance()
  {
    constexpr std::uint64_t period = 1ULL << 31;
    state = (1103515245ULL * state + 12345ULL) % period;
    return 1. + noise * (2. * static_cast<double>(state) / static_cast<double>(period) - 1.);
  }

  const double noise;
  const bool restarts;
  std::unique_ptr<SkinTuner> tuner;
  unsigned long long step = 0;
  std::uint64_t state = 1;
};

/// Checks that the skin is near the best one, and stays where it is.
/// @param tolerance share of the least cost
void check_flow(const Flow &flow, const double noise, const double tolerance)
{
  Run run(noise);
  run.go(flow, 800);
  check(flow.name + ": near the least cost",
        flow.cost(run.skin()) < (1. + tolerance) * flow.least_cost(),
        "costs " + std::to_string(flow.cost(run.skin())) + " with a skin of " +
            std::to_string(run.skin()) + " instead of " + std::to_string(flow.least_cost()));
  const unsigned long long before = run.n_changes();
  run.go(flow, 4000);
  check(flow.name + ": it stays", run.n_changes() == before,
        std::to_string(run.n_changes() - before) + " changes");
}

void check_following()
{
  Run run(0.05), restarted(0.05, true);
  std::string skins;
  bool ok = true;
  for (const Flow &flow : {gas, plough, soft, plough, gas}) {
    run.go(flow, 200);
    restarted.go(flow, 200);
    ok = ok && flow.cost(run.skin()) < 1.06 * flow.least_cost();
    skins += " " + std::to_string(run.skin());
  }
  check("it follows a flow that changes", ok, skins);
  check("with restarts, too", restarted.history == run.history);
  run.go(rest, 200);
  check("at rest lists become short", run.skin() < 0.2, std::to_string(run.skin()));
}

bool is_refused(const double skin)
{
  nlohmann::ordered_json saved = SkinTuner(1., first, most).save();
  saved["skin"] = skin;
  try {
    SkinTuner(1., first, most).load(saved);
  } catch (const std::invalid_argument &) {
    return true;
  }
  return false;
}

} // namespace

EUNOE_TEST()
{
  check_flow(gas, 0., 0.05);
  check_flow(plough, 0., 0.05);
  check_flow(soft, 0., 0.05);
  const std::string disturbed = ", disturbed";
  for (Flow flow : {gas, plough, soft}) {
    flow.name += disturbed;
    check_flow(flow, 0.05, 0.05);
  }
  check_flow({"mostly asleep", 100., 6., 1., 0.1}, 0.05, 0.05);
  check_flow({"searches more seldom", 340., 6.6, 1.5, 1.}, 0.05, 0.1);
  check_flow({"searches more often", 340., 6.6, 0.8, 1.}, 0.05, 0.1);
  check_following();

  SkinTuner narrow(1., 0.2, 0.2);
  for (unsigned long long step = 5; step < 1000; step += 5) {
    narrow.tune(step, {1000, 1000, 500});
    narrow.note_search(step);
  }
  check("never wider than the domain allows", narrow.skin() == 0.2);
  check("without particles nothing changes", !narrow.tune(100000, {}));
  narrow.note_search(10);
  check("after a long rest it looks", !narrow.is_look_due(5009) && narrow.is_look_due(5010));
  check("no skin in a checkpoint", is_refused(0.) && is_refused(2.) && !is_refused(0.5));
}
