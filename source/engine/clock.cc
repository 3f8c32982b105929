#include <eunoe/checkpoint/head_values.h>
#include <eunoe/engine/clock.h>

namespace eunoe {

nlohmann::ordered_json Clock::save() const
{
  return {
      {"step", present}, {"time_step", dt}, {"begin_step", begin_step}, {"begin_time", begin_time}};
}

void Clock::load(const nlohmann::ordered_json &saved, const End &end)
{
  present = first = count_in(saved.at("step"));
  begin_step = count_in(saved.at("begin_step"));
  begin_time = number_in(saved.at("begin_time"));
  last = end(begin_step, begin_time);
}

void Clock::begin_phase(const nlohmann::ordered_json &saved, const End &end)
{
  load(saved, end);
  const double earlier_dt = number_in(saved.at("time_step"));
  if (earlier_dt != dt) {
    begin_time += static_cast<double>(present - begin_step) * earlier_dt;
    begin_step = present;
  }
  last = end(present, time());
}

} // namespace eunoe
