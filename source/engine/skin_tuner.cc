#include <eunoe/checkpoint/head_values.h>
#include <eunoe/engine/skin_tuner.h>

#include <cmath>

namespace eunoe {

bool SkinTuner::is_complete() const
{
  // So many that a single fast grain or a moment of rest does not decide.
  constexpr std::uint64_t fewest_searches = 8, fewest_steps = 250;
  return (window.searches >= fewest_searches && window.steps >= fewest_steps) ||
         window.steps >= longest_wait;
}

double SkinTuner::cost(const double skin) const
{
  const auto particles = static_cast<double>(window.load.particles);
  const double awake = static_cast<double>(window.load.awake) / particles;
  // What moves takes as long as the skin is wide.
  const double steps =
      static_cast<double>(window.steps) / static_cast<double>(window.searches) * skin / now;
  // Around a particle the others are as dense at any distance.
  const double wider = (diameter + skin) / (diameter + now);
  const double pairs = static_cast<double>(window.load.pairs) / particles * wider * wider * wider;
  return (costs.search + costs.found_pair * pairs) / steps +
         awake * pairs * (costs.listed_pair + costs.look / std::sqrt(steps));
}

double SkinTuner::best() const
{
  // Of the diameter, also the least: between neighbours there is hardly a difference. What is far
  // from the present skin is known too little.
  constexpr double pitch = 0.05, farthest = 2.;
  double found = now, least = cost(now);
  for (unsigned int k = 1; k * pitch * diameter <= most; ++k) {
    const double skin = k * pitch * diameter;
    if (skin * farthest < now || skin > farthest * now)
      continue;
    const double its_cost = cost(skin);
    if (its_cost < least) {
      least = its_cost;
      found = skin;
    }
  }
  return found;
}

bool SkinTuner::pays(const double skin) const
{
  // A gain below these shares, of a step and of what is to be saved, is none that can be known, and
  // the skin would wander. The flow is taken to last for some windows.
  constexpr double least_of_step = 0.005, least_share = 0.05, windows = 4.;
  const double present = cost(now), gain = present - cost(skin);
  const double awake =
      static_cast<double>(window.load.awake) / static_cast<double>(window.load.particles);
  return gain > 0. && gain >= least_of_step * awake && gain >= least_share * present &&
         gain * windows * static_cast<double>(window.steps) >= costs.change;
}

bool SkinTuner::tune(const unsigned long long step, const SearchLoad &load)
{
  if (load.particles == 0 || step <= last_search)
    return false;
  ++window.searches;
  window.steps += step - last_search;
  window.load.particles += load.particles;
  window.load.awake += load.awake;
  window.load.pairs += load.pairs;
  if (!is_complete())
    return false;
  const double wanted = best();
  const bool changes_now = pays(wanted);
  window = Window();
  if (!changes_now)
    return false;
  now = wanted;
  ++changes;
  return true;
}

nlohmann::ordered_json SkinTuner::save() const
{
  return {{"skin", now},
          {"last_search", last_search},
          {"searches", window.searches},
          {"steps", window.steps},
          {"particles", window.load.particles},
          {"awake", window.load.awake},
          {"pairs", window.load.pairs}};
}

void SkinTuner::load(const nlohmann::ordered_json &saved)
{
  const double skin = number_in(saved.at("skin"));
  if (!(skin > 0. && skin <= most))
    throw std::invalid_argument("this is no skin");
  now = skin;
  last_search = count_in(saved.at("last_search"));
  window.searches = count_in(saved.at("searches"));
  window.steps = count_in(saved.at("steps"));
  window.load.particles = count_in(saved.at("particles"));
  window.load.awake = count_in(saved.at("awake"));
  window.load.pairs = count_in(saved.at("pairs"));
}

} // namespace eunoe
