#include <eunoe/checkpoint/head_values.h>
#include <eunoe/engine/clock.h>

namespace eunoe {

nlohmann::ordered_json Clock::save() const
{
  nlohmann::ordered_json saved;
  saved["step"] = present;
  return saved;
}

void Clock::load(const nlohmann::ordered_json &saved)
{
  present = first = count_in(saved.at("step"));
}

} // namespace eunoe
